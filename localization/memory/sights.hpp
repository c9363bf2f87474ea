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

/// The nearest and the farthest surface of a scan in each direction from its sensor.
class SightRing {
 public:
  explicit SightRing(const SurfaceScan& scan);

  /// What this scan says of the points of `other`; `here_from_there` is the pose of the other.
  [[nodiscard]] SightCount of(const SurfaceScan& other, const Transform2<Base, Base>& here_from_there) const;

 private:
  static constexpr std::size_t kBins = 720;
  struct Bin {
    float near_m = 0.0F;
    float far_m = -1.0F;  ///< below 0: nothing was seen there
  };
  void mark(std::size_t bin, double range_m);

  Point2<Base> sensor_;
  std::vector<Bin> bins_;
};

}  // namespace madori::localization
