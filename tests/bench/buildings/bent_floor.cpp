#include "tests/bench/buildings/bent_floor.hpp"

#include <algorithm>
#include <cmath>

#include "core/result.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::bench {
namespace {

constexpr double kStepS = 0.02;
constexpr std::uint64_t kStream = 0x2D;

Point2<Metric> metric(const test::BentBuilding& building, const Point2<Map>& drawn) {
  const auto p = building.warp->building(drawn);
  return {p.x_m, p.y_m};
}

/// Points of the lap along its legs, no farther apart than 1.5 m, in building metres.
std::vector<Point2<Metric>> lap_points(const test::BentBuilding& building, double metres) {
  constexpr double kApartM = 1.5;
  const auto& nodes = building.routes.nodes();
  std::vector<Point2<Metric>> points{metric(building, nodes[building.lap.front()].position)};
  double way_m = 0.0;
  for (std::size_t i = 0; way_m < metres; i = (i + 1) % (building.lap.size() - 1)) {
    const auto& a = nodes[building.lap[i]].position;
    const auto& b = nodes[building.lap[i + 1]].position;
    const int pieces = std::max(1, static_cast<int>(std::ceil(distance_m(a, b) / kApartM)));
    for (int k = 1; k <= pieces && way_m < metres; ++k) {
      const double t = static_cast<double>(k) / pieces;
      points.push_back(metric(building, {a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)}));
      way_m += distance_m(points[points.size() - 2], points.back());
    }
  }
  return points;
}

}  // namespace

mapping::Walls walls_of(const test::BentBuilding& building) {
  mapping::Walls walls;
  for (const auto& wall : building.truth) {
    const bool is_furniture = std::any_of(building.furniture.begin(), building.furniture.end(),
                                          [&](const auto& piece) { return piece.segment == wall.segment; });
    if (!is_furniture) walls.push_back(wall);
  }
  return walls;
}

simulation::Scenario scenario_of(const test::BentBuilding& building) {
  constexpr std::size_t kFacesOfOnePiece = 3;
  simulation::Scenario scenario;
  scenario.seed = building.options.seed;
  scenario.building.wall_height_m = scenario.building.ceiling_height_m = 2.8;
  scenario.vlp16.keep_every_firing = 3;
  simulation::Random random(scenario.seed, kStream, 0);
  scenario.vehicle.left_radius_error_percent = random.uniform(-0.3, 0.3);
  scenario.vehicle.right_radius_error_percent = random.uniform(-0.3, 0.3);
  scenario.vehicle.separation_error_percent = random.uniform(-1.0, 1.0);
  scenario.vehicle.slip_noise = 0.001;
  double height_m = 0.0;
  for (std::size_t i = 0; i < building.furniture.size(); ++i) {
    if (i % kFacesOfOnePiece == 0) height_m = random.uniform(0.8, 2.4);
    const auto& [a, b] = building.furniture[i].segment;
    simulation::SolidSpec face;
    face.kind = simulation::SolidKind::Clutter;
    face.centre = {(a.x_m + b.x_m) / 2.0, (a.y_m + b.y_m) / 2.0};
    face.yaw_deg = to_deg(std::atan2(b.y_m - a.y_m, b.x_m - a.x_m));
    face.length_m = std::max(0.05, distance_m(a, b));
    face.width_m = 0.02;
    face.height_m = height_m;
    scenario.solids.push_back(face);
  }
  return scenario;
}

LapDriver::LapDriver(const test::BentBuilding& building, double metres) {
  std::vector<planning::WayCorner> way;
  for (const auto& point : lap_points(building, metres)) way.push_back({point});
  auto path = planning::make_waypoints(way);
  if (!path) throw Error("the lap", path.reason(), "");
  path_ = control::TrackedPath(std::move(path).value(), options_.speed);
}

Transform2<Metric, Base> LapDriver::start() const {
  const auto& first = path_.points().front();
  return {first.position.x_m, first.position.y_m, first.heading_rad};
}

VelocityCommand LapDriver::command(const Transform2<Metric, Base>& truth) {
  const auto out = control::pursue(path_, pursuit_, {.map_from_base = truth}, options_);
  pursuit_ = out.state;
  arrived_ = arrived_ || out.status == control::PursuitStatus::Arrived ||
             out.status == control::PursuitStatus::OffPath;
  const auto limited = control::limit(
      limits_, {.requested = arrived_ ? VelocityCommand{} : out.command, .may_move = true, .step_s = kStepS},
      {});
  limits_ = limited.state;
  return limited.command;
}

}  // namespace madori::bench
