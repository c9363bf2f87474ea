#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/frames.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// The last two scans side by side: was the later one taken from where the wheels say that it was? Needs no
/// drawing, so that a vehicle which is carried off is noticed also where the other place is drawn alike: of
/// two bays no two look alike from one tenth of a second to the next.
class RecentView {
 public:
  /// Farther apart, two scans say nothing about each other.
  static constexpr Duration kRecent = std::chrono::milliseconds(500);

  /// Into which the field of view is divided.
  static constexpr std::size_t kSectors = 360;

  /// A scan, Base frame at `stamp`; the one before it becomes the one that it is compared with.
  void take(Stamp stamp, const ScanPoints& points);
  /// Share of the surfaces, 0..1, that both scans saw: mean of the later's in the earlier and the earlier's
  /// in the later. `before_from_now` is the pose of the later in the earlier. 1 where there is nothing to
  /// compare.
  [[nodiscard]] double kept(const Transform2<Base, Base>& before_from_now) const;
  /// Takes note of a share that was usual.
  void learn(double kept);
  /// By how much a share is below what learn() was told on average: noise and clutter differ from lidar to
  /// lidar. Never positive before a few scans.
  [[nodiscard]] double fall(double kept) const { return learned_ < kFewest ? 0.0 : usual_ - kept; }

 private:
  static constexpr int kFewest = 3;
  /// The points of a scan, sorted by the cell of a grid.
  struct Surfaces {
    struct Point {
      std::uint64_t cell = 0;
      double x_m = 0.0, y_m = 0.0, weight = 0.0;
    };
    Stamp stamp{};
    std::vector<Point> points;
    std::array<float, kSectors> reach_m{};  ///< of the farthest return of each direction, 0 for none
    [[nodiscard]] bool could_see(const Point2<Base>& p) const;
    void fill_gaps();
    [[nodiscard]] bool has_near(const Point2<Base>& p, double within_m) const;
    /// Share of the weight of `others` that lies where this one has a surface.
    [[nodiscard]] double share_of(const Surfaces& others,
                                  const Transform2<Base, Base>& this_from_others) const;
  };
  Surfaces before_;
  Surfaces now_;
  double usual_ = 0.0;
  int learned_ = 0;
};

}  // namespace madori::localization
