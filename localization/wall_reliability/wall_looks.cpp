#include "localization/wall_reliability/wall_looks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/median.hpp"

namespace madori::localization {
namespace {

/// A return as seen from the sensor, Map frame.
struct Beam {
  double bearing_rad = 0.0;
  double dx = 1.0;
  double dy = 0.0;
  double range_m = 0.0;
  double normal_x = 0.0;  ///< (0, 0) where the surface's direction is not known
  double normal_y = 0.0;
};

std::vector<Beam> beams_of(const SurfaceScan& scan, const Transform2<Map, Base>& pose,
                           const Point2<Map>& sensor) {
  std::vector<Beam> beams;
  beams.reserve(scan.points.size());
  for (const SurfacePoint& p : scan.points) {
    const SurfacePoint q = moved(pose, p);
    const double range = distance_m(Point2<Map>{q.x_m, q.y_m}, sensor);
    if (range <= 0.0) continue;
    Beam b{0.0, (q.x_m - sensor.x_m) / range, (q.y_m - sensor.y_m) / range, range};
    b.bearing_rad = std::atan2(b.dy, b.dx);
    b.normal_x = q.normal_x;
    b.normal_y = q.normal_y;
    beams.push_back(b);
  }
  std::sort(beams.begin(), beams.end(), [](const Beam& a, const Beam& b) {
    return a.bearing_rad != b.bearing_rad ? a.bearing_rad < b.bearing_rad : a.range_m < b.range_m;
  });
  return beams;
}

/// The bearings between two ends, as the sensor sees them.
struct Fan {
  double from_rad = 0.0;
  double width_rad = -1.0;  ///< below zero: none

  [[nodiscard]] bool holds(double bearing_rad) const {
    double turn = bearing_rad - from_rad;
    if (turn < 0.0) turn += 2.0 * kPi;
    return turn <= width_rad;
  }
};

/// `margin`: share of it that is left out at either end.
Fan fan_of(const Segment2<Map>& s, const Point2<Map>& sensor, double margin) {
  const double a = std::atan2(s.a.y_m - sensor.y_m, s.a.x_m - sensor.x_m);
  const double turn = wrap_angle(std::atan2(s.b.y_m - sensor.y_m, s.b.x_m - sensor.x_m) - a);
  const double width = std::abs(turn);
  return {wrap_angle((turn >= 0.0 ? a : a + turn) + margin * width), (1.0 - 2.0 * margin) * width};
}

/// What is left of a piece whose ends may be nearer by `slack_m` each; nothing of a short one.
std::optional<Segment2<Map>> surely(const Segment2<Map>& s, double slack_m) {
  const double share = slack_m / s.length_m();
  if (share >= 0.5) return std::nullopt;
  const double dx = share * (s.b.x_m - s.a.x_m), dy = share * (s.b.y_m - s.a.y_m);
  return Segment2<Map>{{s.a.x_m + dx, s.a.y_m + dy}, {s.b.x_m - dx, s.b.y_m - dy}};
}

/// The sides of a piece of wall as the sensor sees them.
struct Sight {
  Fan fan;
  Fan through;            ///< only what passes here passes through the wall, and not beside it
  double normal_x = 0.0;  ///< left of a -> b
  double normal_y = 0.0;
  double height_m = 0.0;  ///< of the sensor over the wall's line, signed along the normal
};

std::optional<Sight> sight_of(const Segment2<Map>& s, const Point2<Map>& sensor, const LookOptions& options) {
  const double length = s.length_m();
  const double middle_x = 0.5 * (s.a.x_m + s.b.x_m) - sensor.x_m;
  const double middle_y = 0.5 * (s.a.y_m + s.b.y_m) - sensor.y_m;
  const double distance = std::hypot(middle_x, middle_y);
  Sight sight;
  sight.normal_x = -(s.b.y_m - s.a.y_m) / length;
  sight.normal_y = (s.b.x_m - s.a.x_m) / length;
  sight.height_m = -(sight.normal_x * middle_x + sight.normal_y * middle_y);
  if (distance > options.reach_m || std::abs(sight.height_m) < options.flattest_sine * distance ||
      std::abs(sight.height_m) < 0.1)
    return std::nullopt;
  constexpr double kMargin = 0.05;  // of the piece at either end: there its neighbour may be meant
  sight.fan = fan_of(s, sensor, kMargin);
  return sight;
}

/// Calls visit(beam) for the beams whose bearings lie within the fan.
template <class Visit>
void for_each_beam(const std::vector<Beam>& beams, const Fan& fan, Visit&& visit) {
  const auto by_bearing = [](const Beam& b, double bearing) { return b.bearing_rad < bearing; };
  const auto first = static_cast<std::size_t>(
      std::lower_bound(beams.begin(), beams.end(), fan.from_rad, by_bearing) - beams.begin());
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const Beam& beam = beams[(first + k) % beams.size()];
    if (!fan.holds(beam.bearing_rad)) return;
    visit(beam);
  }
}

class Looker {
 public:
  Looker(const WallCells& cells, const WallIndex& index, const Point2<Map>& sensor,
         const Eigen::Matrix3d& covariance, const LookOptions& options)
      : cells_(cells), index_(index), sensor_(sensor), covariance_(covariance), options_(options) {}

  /// nullopt where nothing was learned.
  std::optional<WallLook> look(std::uint32_t cell, const std::vector<Beam>& beams, const Point2<Map>& base) {
    const Segment2<Map>& piece = cells_.all()[cell].segment;
    auto sight = sight_of(piece, sensor_, options_);
    if (!sight) return std::nullopt;
    const double along = sigma_m({sight->normal_y, -sight->normal_x}, piece, base);
    if (const auto sure = surely(piece, options_.ends_m + 2.0 * along))
      sight->through = fan_of(*sure, sensor_, 0.0);
    WallLook look{cell};
    offsets_.clear();
    for_each_beam(beams, sight->fan, [&](const Beam& beam) { judge(beam, *sight, look); });
    look.ended = static_cast<int>(offsets_.size());
    if (look.ended + look.passed == 0) return std::nullopt;
    if (look.ended > 0) measure(*sight, base, look);
    return look;
  }

 private:
  void judge(const Beam& beam, const Sight& sight, WallLook& look) {
    const double along_normal = beam.dx * sight.normal_x + beam.dy * sight.normal_y;
    const double offset = sight.height_m + beam.range_m * along_normal;
    // Behind the wall as seen from the sensor: on the other side of its line.
    const double behind = sight.height_m > 0.0 ? -offset : offset;
    const double cosine = beam.normal_x * sight.normal_x + beam.normal_y * sight.normal_y;
    const bool knows = beam.normal_x != 0.0 || beam.normal_y != 0.0;
    if (std::abs(offset) <= options_.beside_m && knows && std::abs(cosine) >= options_.parallel_cosine &&
        belongs(beam, sight, look.cell, offset)) {
      offsets_.push_back(offset);
    } else if (behind > options_.through_m && sight.through.holds(beam.bearing_rad)) {
      ++look.passed;
    }
  }

  /// Is this the nearest drawn wall of the surface's direction?
  [[nodiscard]] bool belongs(const Beam& beam, const Sight& sight, std::uint32_t cell, double offset) const {
    const double towards = sight.height_m > 0.0 ? 1.0 : -1.0;  // the sensor
    const auto hit =
        index_.nearest(sensor_.x_m + beam.range_m * beam.dx, sensor_.y_m + beam.range_m * beam.dy,
                       WallIndex::direction_of(towards * sight.normal_x, towards * sight.normal_y));
    constexpr double kBorderM = 0.03;  // the index names the nearest wall of a table's cell
    return hit.wall < 0 || hit.wall == static_cast<int>(cells_.all()[cell].wall) ||
           std::hypot(hit.distance_m, hit.beyond_m) > std::abs(offset) - kBorderM;
  }

  void measure(const Sight& sight, const Point2<Map>& base, WallLook& look) {
    look.offset_m = median_of(offsets_);
    const double pose = sigma_m({sight.normal_x, sight.normal_y}, cells_.all()[look.cell].segment, base);
    look.sigma_m = std::hypot(options_.range_sigma_m, pose);
  }

  /// How far the pose lets a piece of wall be off in a direction.
  [[nodiscard]] double sigma_m(const Eigen::Vector2d& direction, const Segment2<Map>& s,
                               const Point2<Map>& base) const {
    const double rx = 0.5 * (s.a.x_m + s.b.x_m) - base.x_m;
    const double ry = 0.5 * (s.a.y_m + s.b.y_m) - base.y_m;
    const Eigen::Vector3d slope(direction.x(), direction.y(), direction.y() * rx - direction.x() * ry);
    return std::sqrt(std::max(0.0, slope.dot(covariance_ * slope)));
  }

  const WallCells& cells_;
  const WallIndex& index_;
  Point2<Map> sensor_;
  const Eigen::Matrix3d& covariance_;
  const LookOptions& options_;
  std::vector<double> offsets_;
};

}  // namespace

std::vector<WallLook> wall_looks(const WallCells& cells, const WallIndex& index, const SurfaceScan& scan,
                                 const Transform2<Map, Base>& map_from_base,
                                 const Eigen::Matrix3d& covariance, const LookOptions& options) {
  const Point2<Map> sensor = map_from_base * scan.sensor;
  const std::vector<Beam> beams = beams_of(scan, map_from_base, sensor);
  std::vector<WallLook> looks;
  if (beams.empty()) return looks;
  Looker looker(cells, index, sensor, covariance, options);
  for (const std::uint32_t cell : cells.near(sensor, options.reach_m))
    if (const auto look = looker.look(cell, beams, map_from_base.translation())) looks.push_back(*look);
  return looks;
}

}  // namespace madori::localization
