#include "localization/mounting/wall_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr double kNearestM = 0.35;  // nearer returns are of the vehicle or its mast
constexpr double kFarthestM = 25.0;
constexpr double kLongestM = 1.0;
constexpr double kShortestM = 0.3;
constexpr std::size_t kFewest = 6;
constexpr double kLeastFacing = 0.26;  // cosine: what is seen more slanted than 75 degrees has a poor line
constexpr double kAboveFloorM = 0.25;
constexpr int kLevelRings = 3;

using Line = std::vector<Point2<Lidar>>;
using Place = Line::const_iterator;

/// The lasers that count: those from just below level upwards. The floor is far out there, the ceiling, too.
std::vector<int> level_rings(const LidarModel& lidar) {
  if (lidar.kind == LidarKind::Planar) return {0};
  std::vector<int> rings;
  const double lowest = to_rad(-1.5);
  for (int ring = 0; static_cast<int>(rings.size()) < kLevelRings; ++ring) {
    const double elevation = lidar.min_elevation_rad + ring * lidar.ring_step_rad;
    if (elevation > lidar.max_elevation_rad + 1e-9 || !(lidar.ring_step_rad > 0.0)) break;
    if (elevation >= lowest) rings.push_back(ring);
  }
  return rings;
}

/// The returns of each laser that counts, in the order in which they were measured, laid into one moment and
/// onto the floor.
std::map<int, Line> lines_of(const PointCloud<Lidar>& cloud, const LidarModel& lidar,
                             const std::optional<FloorSeen>& floor, const MotionInSweep& motion) {
  constexpr float kOneMomentS = 5e-4F;
  const auto rings = level_rings(lidar);
  std::map<int, Line> lines;
  float moment_s = std::nanf("");
  Transform2<Lidar, Lidar> moved;
  for (const CloudPoint& p : cloud.points) {
    if (std::ranges::find(rings, int{p.ring}) == rings.end()) continue;
    double x = p.x_m, y = p.y_m;
    if (floor) {
      const double z = p.z_m;
      if (z + floor->height_m - floor->slope_x * x - floor->slope_y * y < kAboveFloorM) continue;
      x += floor->slope_x * z;  // turned upright about the lidar, first order
      y += floor->slope_y * z;
    }
    const double range = std::hypot(x, y);
    if (!(range > kNearestM && range < kFarthestM)) continue;
    if (!(std::abs(p.time_offset_s - moment_s) < kOneMomentS)) {
      moment_s = p.time_offset_s;
      moved = motion(cloud.stamp + duration_from_seconds(static_cast<double>(moment_s)));
    }
    lines[p.ring].push_back(moved * Point2<Lidar>{x, y});
  }
  return lines;
}

struct Fit {
  WallPiece piece;
  double most_off_m = 0.0;
  Place farthest;
  double rms_m = 0.0;
};

Fit fit_line(Place first, Place last) {
  const auto n = static_cast<double>(last - first);
  Fit fit;
  WallPiece& w = fit.piece;
  for (Place p = first; p != last; ++p) w.centre = {w.centre.x_m + p->x_m / n, w.centre.y_m + p->y_m / n};
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (Place p = first; p != last; ++p) {
    const double dx = p->x_m - w.centre.x_m, dy = p->y_m - w.centre.y_m;
    xx += dx * dx / n, xy += dx * dy / n, yy += dy * dy / n;
  }
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  w.normal_x = -std::sin(direction), w.normal_y = std::cos(direction);
  if (w.normal_x * w.centre.x_m + w.normal_y * w.centre.y_m > 0.0)
    w.normal_x = -w.normal_x, w.normal_y = -w.normal_y;
  const double half = std::hypot(0.5 * (xx - yy), xy);
  w.spread_m = std::sqrt(0.5 * (xx + yy) + half);
  fit.rms_m = std::sqrt(std::max(0.0, 0.5 * (xx + yy) - half));
  w.points = static_cast<int>(last - first);
  fit.farthest = first;
  for (Place p = first; p != last; ++p) {
    const double off = std::abs(w.normal_x * (p->x_m - w.centre.x_m) + w.normal_y * (p->y_m - w.centre.y_m));
    if (off > fit.most_off_m) fit.most_off_m = off, fit.farthest = p;
  }
  return fit;
}

bool is_wall(const Fit& fit, double sigma_m) {
  const WallPiece& w = fit.piece;
  const double range = std::hypot(w.centre.x_m, w.centre.y_m);
  const double facing = -(w.normal_x * w.centre.x_m + w.normal_y * w.centre.y_m) / range;
  const double length = std::sqrt(12.0) * w.spread_m;
  return w.points >= static_cast<int>(kFewest) && length > kShortestM && facing > kLeastFacing &&
         fit.rms_m < 1.5 * sigma_m + 0.005;
}

/// A run of neighbours is split where it leaves its line most, until every part is a line; what is longer
/// than a piece may be becomes several.
void split(Place first, Place last, double sigma_m, std::vector<WallPiece>& pieces) {
  if (last - first < static_cast<std::ptrdiff_t>(kFewest)) return;
  const Fit fit = fit_line(first, last);
  const double length = distance_m(*first, *(last - 1));
  if (fit.most_off_m > 4.0 * sigma_m + 0.01) {
    const bool inside = fit.farthest - first >= 2 && last - fit.farthest > 2;
    const Place middle = inside ? fit.farthest : first + (last - first) / 2;
    split(first, middle, sigma_m, pieces);
    split(middle, last, sigma_m, pieces);
  } else if (length > kLongestM) {
    const Place middle = first + (last - first) / 2;
    split(first, middle, sigma_m, pieces);
    split(middle, last, sigma_m, pieces);
  } else if (is_wall(fit, sigma_m)) {
    pieces.push_back(fit.piece);
  }
}

}  // namespace

std::vector<WallPiece> wall_pieces(const PointCloud<Lidar>& cloud, const LidarModel& lidar,
                                   const std::optional<FloorSeen>& floor, const MotionInSweep& motion) {
  std::vector<WallPiece> pieces;
  for (const auto& [ring, line] : lines_of(cloud, lidar, floor, motion)) {
    Place first = line.begin();
    for (Place p = line.begin(); p != line.end(); ++p) {
      const bool ends = p + 1 == line.end() ||
                        distance_m(*p, *(p + 1)) >
                            0.1 + 6.0 * lidar.step_rad * std::hypot(p->x_m, p->y_m) + 3.0 * lidar.sigma_m;
      if (!ends) continue;
      split(first, p + 1, lidar.sigma_m, pieces);
      first = p + 1;
    }
  }
  return pieces;
}

}  // namespace madori::localization
