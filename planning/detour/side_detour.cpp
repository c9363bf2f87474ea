#include "planning/detour/side_detour.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/angle.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::planning {
namespace {

/// From 0 to 1 with level ends and bounded curvature.
double smooth_step(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

/// Distances from `from` along the path, as far as the first turn on the spot.
std::vector<double> distances(const Path& path, std::size_t from) {
  std::vector<double> along_m{0.0};
  for (std::size_t i = from + 1; i < path.points.size(); ++i) {
    const double step_m = distance_m(path.points[i - 1].position, path.points[i].position);
    if (step_m < kSamePointM) break;
    along_m.push_back(along_m.back() + step_m);
  }
  return along_m;
}

/// Where the full offset begins and ends, and where the route is met again; metres after `from`.
struct Stretch {
  double out_begin_m, out_end_m, back_begin_m, back_end_m;
};

std::optional<Stretch> stretch(const std::vector<double>& along_m, std::size_t from, const PathCheck& check,
                               double offset_m, const CheckOptions& options,
                               const SideDetourOptions& detour) {
  const double run_m = std::max(detour.min_run_m, detour.run_per_offset * std::abs(offset_m));
  const std::size_t last = check.last_blocked - from;
  if (last >= along_m.size()) return std::nullopt;
  const double passed_m = along_m[last] + options.vehicle.rear_m + detour.before_rejoin_m;
  const Stretch s{0.0, run_m, std::max(run_m, passed_m), std::max(run_m, passed_m) + run_m};
  if (s.back_end_m > along_m.back()) return std::nullopt;
  return s;
}

Detour shifted(const Path& path, std::size_t from, const std::vector<double>& along_m, const Stretch& s,
               double offset_m, double speed_mps) {
  Detour result;
  result.offset_m = offset_m;
  for (std::size_t i = from; i < path.points.size(); ++i) {
    PathPoint point = path.points[i];
    if (i - from < along_m.size() && along_m[i - from] < s.back_end_m) {
      const double at_m = along_m[i - from];
      const double share = smooth_step((at_m - s.out_begin_m) / (s.out_end_m - s.out_begin_m)) -
                           smooth_step((at_m - s.back_begin_m) / (s.back_end_m - s.back_begin_m));
      point.position.x_m -= share * offset_m * std::sin(point.heading_rad);
      point.position.y_m += share * offset_m * std::cos(point.heading_rad);
      point.speed_limit_mps = std::min(point.speed_limit_mps, speed_mps);
      result.rejoin = result.path.points.size() + 1;
    }
    result.path.points.push_back(point);
  }
  renew_headings(result.path, 0, result.rejoin);
  return result;
}

/// Whether the vehicle can follow: inside a bend an offset beyond its radius folds the path back on itself.
bool is_drivable(const Path& path, std::size_t last, double min_radius_m) {
  const auto& points = path.points;
  for (std::size_t i = 1; i + 1 < points.size() && i <= last; ++i) {
    const double in_m = distance_m(points[i - 1].position, points[i].position);
    const double out_m = distance_m(points[i].position, points[i + 1].position);
    if (in_m < kSamePointM || out_m < kSamePointM) continue;  // a turn on the spot of the route
    const double turn_rad = wrap_angle(std::atan2(points[i + 1].position.y_m - points[i].position.y_m,
                                                  points[i + 1].position.x_m - points[i].position.x_m) -
                                       std::atan2(points[i].position.y_m - points[i - 1].position.y_m,
                                                  points[i].position.x_m - points[i - 1].position.x_m));
    if (std::abs(turn_rad) > 0.5 * (in_m + out_m) / min_radius_m) return false;
  }
  return true;
}

}  // namespace

void renew_headings(Path& path, std::size_t first, std::size_t last) {
  auto& points = path.points;
  last = std::min(last, points.size() - 1);
  for (std::size_t i = first + 1; i < last; ++i) {
    const Point2<Map>& a = points[i - 1].position;
    const Point2<Map>& b = points[i + 1].position;
    points[i].heading_rad = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
  }
  for (std::size_t i = first + 1; i < last; ++i) {
    const double way_m = distance_m(points[i - 1].position, points[i + 1].position);
    if (way_m > kSamePointM)
      points[i].curvature_per_m = wrap_angle(points[i + 1].heading_rad - points[i - 1].heading_rad) / way_m;
  }
}

Result<Detour> side_detour(const Path& path, std::size_t from, const PathCheck& check,
                           const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                           const CheckOptions& options, const SideDetourOptions& detour) {
  const auto along_m = distances(path, from);
  const int offsets =
      1 + static_cast<int>((detour.furthest_m - detour.first_offset_m) / detour.offset_step_m + 1e-9);
  for (int i = 0; i < offsets; ++i) {
    const double offset_m = detour.first_offset_m + i * detour.offset_step_m;
    const auto around = stretch(along_m, from, check, offset_m, options, detour);
    if (!around) break;
    for (const double side : {1.0, -1.0}) {
      Detour candidate = shifted(path, from, along_m, *around, side * offset_m, detour.speed_mps);
      if (!is_drivable(candidate.path, candidate.rejoin, detour.min_radius_m)) continue;
      const double ahead_m = 2.0 * around->back_end_m;  // the way around is longer than the route
      const PathCheck free = check_path(candidate.path, 0, ahead_m, obstacles, walls, options);
      if (!free.blocked() || free.first_blocked > candidate.rejoin) return candidate;
    }
  }
  return Result<Detour>::failure("no way around on either side within " +
                                 std::to_string(static_cast<int>(detour.furthest_m * 100.0)) +
                                 " cm of the route");
}

}  // namespace madori::planning
