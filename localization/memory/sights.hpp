#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// What two scans say of each other at given poses, in surface points: seen by both; seen by one where the
/// other looked through; what is hidden or out of view says nothing.
struct SightCount {
  int agree = 0;
  int through = 0;

  SightCount& operator+=(const SightCount& other) {
    agree += other.agree;
    through += other.through;
    return *this;
  }
  [[nodiscard]] int both() const { return agree + through; }
  /// Share that contradicts, 0..1. At its right pose a scan contradicts another by what moved and by glass.
  [[nodiscard]] double contradiction() const {
    return both() > 0 ? static_cast<double>(through) / both() : 0.0;
  }
};

/// A surface is passed by so much nearer or farther, and by this share of its distance: slanted walls, the
/// heading's error.
inline constexpr double kSightMarginM = 0.15;
inline constexpr double kSightMarginShare = 0.03;

/// What a scan says of a place.
enum class Look {
  Nothing,  ///< hidden, out of view, or between what it saw at several distances in that direction
  Hit,      ///< a surface is there
  Through,  ///< all that was seen in that direction lies beyond
};

/// The nearest and the farthest surface of a scan in each direction from its sensor.
class SightRing {
 public:
  explicit SightRing(const SurfaceScan& scan);

  /// What this scan says of the points of `other`; `here_from_there` is the pose of the other.
  [[nodiscard]] SightCount of(const SurfaceScan& other, const Transform2<Base, Base>& here_from_there) const;
  /// What this scan says of a place in its own frame.
  [[nodiscard]] Look at(const Point2<Base>& place) const;
  [[nodiscard]] const Point2<Base>& sensor() const { return sensor_; }
  /// Nothing is known from here on, metres from the sensor.
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  static constexpr std::size_t kBins = 720;
  struct Bin {
    float near_m = 0.0F;
    float far_m = -1.0F;  ///< below 0: nothing was seen there
  };
  void mark(std::size_t bin, double range_m);
  [[nodiscard]] Bin towards(double dx, double dy) const;

  Point2<Base> sensor_;
  double reach_m_ = 0.0;
  std::vector<Bin> bins_;
};

/// What two scans say of each other; the ring is that of the first.
[[nodiscard]] SightCount sights_of_each_other(const SurfaceScan& here, const SightRing& ring,
                                              const SurfaceScan& there,
                                              const Transform2<Base, Base>& here_from_there);
[[nodiscard]] SightCount sights_of_each_other(const SurfaceScan& here, const SurfaceScan& there,
                                              const Transform2<Base, Base>& here_from_there);

}  // namespace madori::localization
