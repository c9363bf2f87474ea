#include "planning/waypoints/waypoints.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/angle.hpp"

namespace madori::planning {
namespace {

constexpr double kStraightRad = 1e-6;
constexpr double kDifferentHeadingRad = to_rad(0.1);

/// A straight or circular piece; the heading turns by curvature * length.
struct Stroke {
  Point2<Map> start;
  double heading_rad = 0.0;
  double length_m = 0.0;
  double curvature_per_m = 0.0;
  double speed_limit_mps = 0.0;
  bool turns_before = false;  ///< the vehicle turns on the spot before this stroke
};

PathPoint point_at(const Stroke& s, double along_m) {
  const double half_turn = 0.5 * s.curvature_per_m * along_m;
  const double chord = std::abs(half_turn) < 1e-9 ? along_m : along_m * std::sin(half_turn) / half_turn;
  const double direction = s.heading_rad + half_turn;
  return {{s.start.x_m + chord * std::cos(direction), s.start.y_m + chord * std::sin(direction)},
          wrap_angle(s.heading_rad + 2.0 * half_turn),
          s.curvature_per_m,
          s.speed_limit_mps};
}

std::vector<WayCorner> without_repetitions(const std::vector<WayCorner>& way) {
  std::vector<WayCorner> distinct;
  for (const WayCorner& corner : way)
    if (distinct.empty() || distance_m(distinct.back().position, corner.position) > kSamePointM)
      distinct.push_back(corner);
  return distinct;
}

double heading_between(const Point2<Map>& a, const Point2<Map>& b) {
  return std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
}

/// How far before and after a corner of this turn the rounding arc begins; zero: turned on the spot.
double tangent_length(double turn_rad, double room_m, const WaypointOptions& options) {
  const double tangent = std::tan(std::abs(turn_rad) / 2.0);
  const double cut_per_radius = 1.0 / std::cos(turn_rad / 2.0) - 1.0;
  const double radius =
      std::min({options.corner_radius_m, room_m / tangent, options.max_corner_cut_m / cut_per_radius});
  return radius >= options.min_radius_m ? radius * tangent : 0.0;
}

std::vector<Stroke> strokes_of(const std::vector<WayCorner>& way, const WaypointOptions& options) {
  std::vector<Stroke> strokes;
  double begun_m = 0.0;  // of the leg, by the arc before it
  bool turns_before = false;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const double heading = heading_between(way[i].position, way[i + 1].position);
    const double leg_m = distance_m(way[i].position, way[i + 1].position);
    const double speed = way[i + 1].speed_limit_mps;
    const bool last = i + 2 == way.size();
    const double turn =
        last ? 0.0 : wrap_angle(heading_between(way[i + 1].position, way[i + 2].position) - heading);
    const bool corner = std::abs(turn) > kStraightRad;
    const double next_m = last ? 0.0 : distance_m(way[i + 1].position, way[i + 2].position);
    const double cut_m = corner ? tangent_length(turn, 0.5 * std::min(leg_m, next_m), options) : 0.0;
    const Stroke whole{way[i].position, heading, leg_m, 0.0, speed, turns_before};
    strokes.push_back(
        {point_at(whole, begun_m).position, heading, leg_m - begun_m - cut_m, 0.0, speed, turns_before});
    if (cut_m > 0.0) {
      const double radius = cut_m / std::tan(std::abs(turn) / 2.0);
      strokes.push_back({point_at(whole, leg_m - cut_m).position, heading, radius * std::abs(turn),
                         std::copysign(1.0 / radius, turn), std::min(speed, way[i + 2].speed_limit_mps),
                         false});
    }
    turns_before = corner && cut_m == 0.0;
    begun_m = cut_m;
  }
  return strokes;
}

/// Equal spacing over strokes that are driven without a turn on the spot between them.
void sample(const Stroke* first, const Stroke* end, double spacing_m, Path& path) {
  double total_m = 0.0;
  for (const Stroke* s = first; s != end; ++s) total_m += s->length_m;
  const int pieces = std::max(1, static_cast<int>(std::lround(total_m / spacing_m)));
  const Stroke* stroke = first;
  double passed_m = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const double along_m = total_m * i / pieces;
    while (stroke + 1 != end && along_m > passed_m + stroke->length_m) passed_m += (stroke++)->length_m;
    path.points.push_back(point_at(*stroke, std::min(along_m - passed_m, stroke->length_m)));
  }
}

}  // namespace

Result<Path> make_waypoints(const std::vector<WayCorner>& corners, const WaypointOptions& options,
                            std::optional<double> final_heading_rad) {
  const auto way = without_repetitions(corners);
  if (way.size() < 2) return Result<Path>::failure("the way has less than two different points");
  const auto strokes = strokes_of(way, options);
  double length_m = 0.0;
  for (const Stroke& stroke : strokes) length_m += stroke.length_m;
  if (!(length_m / options.spacing_m <= kMostWaypoints))
    return Result<Path>::failure("the way needs more than two million waypoints");
  Path path;
  for (std::size_t first = 0; first < strokes.size();) {
    std::size_t end = first + 1;
    while (end < strokes.size() && !strokes[end].turns_before) ++end;
    sample(strokes.data() + first, strokes.data() + end, options.spacing_m, path);
    first = end;
  }
  if (final_heading_rad &&
      std::abs(wrap_angle(*final_heading_rad - path.points.back().heading_rad)) > kDifferentHeadingRad)
    end_in(path, *final_heading_rad);
  return path;
}

void end_in(Path& path, double heading_rad) {
  PathPoint last = path.points.back();
  last.heading_rad = wrap_angle(heading_rad);
  last.curvature_per_m = 0.0;
  path.points.push_back(last);
}

std::string waypoints_csv(const Path& path) {
  std::ostringstream out;
  out.setf(std::ios::fixed);
  out.precision(6);
  out << "ID,x,y\n";
  const Point2<Map>* previous = nullptr;
  int id = 0;
  for (const PathPoint& point : path.points) {
    if (previous == nullptr || distance_m(*previous, point.position) > kSamePointM)
      out << id++ << ',' << point.position.x_m << ',' << point.position.y_m << '\n';
    previous = &point.position;
  }
  return out.str();
}

}  // namespace madori::planning
