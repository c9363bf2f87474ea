#include "app/mapping_drive/mapping_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "localization/drawing_fit/standing.hpp"
#include "localization/drawing_fit/wall_lines.hpp"

namespace madori::app {
namespace {

constexpr double kCellM = 0.08;  ///< of several points in one, a picture needs one
constexpr std::size_t kMostPoints = 20'000;

std::vector<Point2<Map>> points_of(const localization::Memory& memory) {
  std::vector<Point2<Map>> points;
  std::unordered_set<std::uint64_t> taken;
  const auto half = [](double v) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(std::lround(v / kCellM)));
  };
  for (std::size_t k = 0; k < memory.size(); ++k)
    for (const auto& p : memory.keyframes()[k].scan->points) {
      const Point2<Map> at = memory.poses()[k] * Point2<Base>{p.x_m, p.y_m};
      if (taken.insert(half(at.x_m) << 32U | half(at.y_m)).second) points.push_back(at);
    }
  const std::size_t shown = std::min(points.size(), kMostPoints);
  for (std::size_t i = 0; i < shown; ++i) points[i] = points[i * points.size() / shown];
  points.resize(shown);
  return points;
}

}  // namespace

MappingPicture picture_of(const localization::Memory& memory) {
  return {0, points_of(memory), localization::wall_lines(localization::standing_cloud(memory))};
}

}  // namespace madori::app
