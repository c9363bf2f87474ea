#pragma once

#include <cstdint>
#include <vector>

#include "mapping/wall_map/grid_frame.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// A wall as registration wants it: start, direction, length, and how far it is to be believed.
struct GridSegment {
  double ax = 0.0;
  double ay = 0.0;
  double ux = 1.0;  ///< unit vector from start to end
  double uy = 0.0;
  double length = 0.0;
  double weight = 1.0;
};

struct SegmentGridOptions {
  double cell_m = 0.05;
  double radius_m = 3.0;  ///< farther from every wall, a point has no nearest one
};

/// The nearest wall of every place, looked up in one load: each cell names the wall nearest to its centre.
/// Exact up to the cell's size: of two walls nearly as near, either may be named.
class SegmentGrid {
 public:
  /// `reliability` is empty or one a wall, 0..1; walls of reliability 0 are left out.
  explicit SegmentGrid(const mapping::Walls& walls, const SegmentGridOptions& options = {},
                       const std::vector<double>& reliability = {});

  /// The wall nearest to (x, y), Map frame; nullptr when there is none within the radius.
  [[nodiscard]] const GridSegment* nearest(double x_m, double y_m) const {
    const double u = (x_m - frame_.origin.x_m) * cells_per_m_;
    const double v = (y_m - frame_.origin.y_m) * cells_per_m_;
    if (!(u >= 0.0 && v >= 0.0 && u < frame_.width && v < frame_.height)) return nullptr;
    const std::uint32_t id = ids_[static_cast<std::size_t>(v) * frame_.width + static_cast<std::size_t>(u)];
    return id == kNone ? nullptr : &segments_[id];
  }
  [[nodiscard]] const std::vector<GridSegment>& segments() const { return segments_; }
  [[nodiscard]] const mapping::GridFrame& frame() const { return frame_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  mapping::GridFrame frame_;
  double cells_per_m_;
  std::vector<GridSegment> segments_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace madori::localization
