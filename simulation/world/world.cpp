#include "simulation/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/result.hpp"
#include "simulation/scenario/furniture.hpp"
#include "simulation/world/body.hpp"

namespace madori::simulation {
namespace {

Material material_of(SolidKind kind) {
  switch (kind) {
    case SolidKind::Machine:
    case SolidKind::Shelf:
      return Material::Metal;
    case SolidKind::Pillar:
      return Material::Wall;
    case SolidKind::Pallet:
    case SolidKind::Desk:
    case SolidKind::Clutter:
      return Material::Wood;
  }
  return Material::Wood;
}

/// The walls of the scenario's true building, Plan frame.
std::vector<Segment2<Plan>> true_walls(const mapping::Walls& site_walls, const Scenario& s) {
  const bool own = !s.building.walls_file.empty();
  const mapping::Walls walls = own ? mapping::load_walls(s.building.walls_file) : site_walls;
  const Transform2<Plan, Map> plan_from_map = s.map_from_plan.inverse();
  std::set<int> ids, asked(s.building.missing_walls.begin(), s.building.missing_walls.end());
  const std::set<int> missing = asked;
  std::vector<Segment2<Plan>> lines;
  for (const auto& [id, segment, probability] : walls) {
    ids.insert(id);
    if (missing.contains(id)) continue;
    Segment2<Plan> line = own ? Segment2<Plan>{{segment.a.x_m, segment.a.y_m}, {segment.b.x_m, segment.b.y_m}}
                              : plan_from_map * segment;
    for (const auto& [moved, dx, dy] : s.building.moved_walls)
      if (std::find(moved.begin(), moved.end(), id) != moved.end())
        line = {{line.a.x_m + dx, line.a.y_m + dy}, {line.b.x_m + dx, line.b.y_m + dy}};
    lines.push_back(line);
  }
  for (const auto& moved : s.building.moved_walls) asked.insert(moved.ids.begin(), moved.ids.end());
  for (const int id : asked)
    if (!ids.contains(id))
      throw Error("scenario " + s.name, "there is no wall " + std::to_string(id), "see walls.csv");
  lines.insert(lines.end(), s.building.added_walls.begin(), s.building.added_walls.end());
  return lines;
}

}  // namespace

std::vector<Point2<Building>> rectangle(const Point2<Building>& centre, double yaw_rad, double length_m,
                                        double width_m) {
  Body body;
  body.centre = centre;
  body.yaw_rad = yaw_rad;
  body.half_length_m = length_m / 2.0;
  body.half_width_m = width_m / 2.0;
  return outline(body);
}

World::World(const mapping::Walls& walls, const Scenario& scenario) : frames_(scenario.frames()) {
  const auto lines = true_walls(walls, scenario);
  for (const auto& line : lines)
    add_wall({frames_.building(line.a), frames_.building(line.b)}, scenario.building.wall_height_m, "wall");
  for (const auto& office : scenario.offices) add_office(office);
  for (const auto& solid : scenario.solids) add_solid(solid);
  for (const auto& solid : place_furniture(lines, scenario)) add_solid(solid);
  for (const auto& [line, low, high] : scenario.glass) {
    const Segment2<Building> pane{frames_.building(line.a), frames_.building(line.b)};
    mesh_.add_sheet(pane, {low, high}, Material::Glass);
    obstacles_.add({"glass", {pane.a, pane.b}, {low, high}});
  }
  for (const auto& ramp : scenario.ramps) add_ramp(ramp);
  add_shell(scenario.building);
  rays_ = std::make_unique<RayCaster>(mesh_);
}

void World::add_wall(const Segment2<Building>& line, double height_m, const std::string& name) {
  walls_.push_back(line);
  mesh_.add_sheet(line, {0.0, height_m}, Material::Wall);
  obstacles_.add({name, {line.a, line.b}, {0.0, height_m}});
}

void World::add_solid(const SolidSpec& s) {
  const auto floor = rectangle(frames_.building(s.centre), to_rad(s.yaw_deg), s.length_m, s.width_m);
  mesh_.add_prism(floor, {0.0, s.height_m}, material_of(s.kind));
  obstacles_.add({s.name, floor, {0.0, s.height_m}});
}

void World::add_office(const OfficeSpec& o) {
  const auto corners = rectangle(frames_.building(o.centre), to_rad(o.yaw_deg), o.length_m, o.width_m);
  for (std::size_t i = 1; i < 4; ++i) add_wall({corners[i], corners[(i + 1) % 4]}, o.height_m, o.name);
  const auto along = [&](double share) {
    return Point2<Building>{corners[0].x_m + share * (corners[1].x_m - corners[0].x_m),
                            corners[0].y_m + share * (corners[1].y_m - corners[0].y_m)};
  };
  const double half_gap = o.doorway_m / o.length_m / 2.0;
  if (half_gap < 0.5) {
    add_wall({corners[0], along(0.5 - half_gap)}, o.height_m, o.name);
    add_wall({along(0.5 + half_gap), corners[1]}, o.height_m, o.name);
  }
  mesh_.add_quad({Vertex{static_cast<float>(corners[0].x_m), static_cast<float>(corners[0].y_m),
                         static_cast<float>(o.height_m)},
                  Vertex{static_cast<float>(corners[1].x_m), static_cast<float>(corners[1].y_m),
                         static_cast<float>(o.height_m)},
                  Vertex{static_cast<float>(corners[2].x_m), static_cast<float>(corners[2].y_m),
                         static_cast<float>(o.height_m)},
                  Vertex{static_cast<float>(corners[3].x_m), static_cast<float>(corners[3].y_m),
                         static_cast<float>(o.height_m)}},
                 Material::Wall);
}

void World::add_ramp(const RampSpec& r) {
  const Point2<Building> c = frames_.building(r.centre);
  ramps_.push_back({{c.x_m, c.y_m, to_rad(r.yaw_deg)}, r.length_m / 2.0, r.width_m / 2.0, r.rise_m});
  const auto floor = rectangle(c, to_rad(r.yaw_deg), r.length_m, r.width_m);
  const auto vertex = [&](std::size_t i, double z) {
    return Vertex{static_cast<float>(floor[i].x_m), static_cast<float>(floor[i].y_m), static_cast<float>(z)};
  };
  const double top = r.rise_m;
  mesh_.add_quad({vertex(0, 0.0), vertex(1, top), vertex(2, top), vertex(3, 0.0)}, Material::Floor);
  mesh_.add_quad({vertex(1, 0.0), vertex(2, 0.0), vertex(2, top), vertex(1, top)}, Material::Floor);
  mesh_.add_quad({vertex(0, 0.0), vertex(0, 0.0), vertex(1, 0.0), vertex(1, top)}, Material::Floor);
  mesh_.add_quad({vertex(3, 0.0), vertex(3, 0.0), vertex(2, 0.0), vertex(2, top)}, Material::Floor);
}

void World::add_shell(const BuildingSpec& building) {
  constexpr double kMarginM = 30.0;
  Point2<Building> low{0.0, 0.0}, high{0.0, 0.0};
  for (const auto& w : walls_) {
    low = {std::min({low.x_m, w.a.x_m, w.b.x_m}), std::min({low.y_m, w.a.y_m, w.b.y_m})};
    high = {std::max({high.x_m, w.a.x_m, w.b.x_m}), std::max({high.y_m, w.a.y_m, w.b.y_m})};
  }
  low = {low.x_m - kMarginM, low.y_m - kMarginM};
  high = {high.x_m + kMarginM, high.y_m + kMarginM};
  mesh_.add_level(low, high, 0.0, Material::Floor);
  mesh_.add_level(low, high, building.ceiling_height_m, Material::Wall);
}

FloorAt World::floor_at(const Point2<Building>& p) const {
  for (const Ramp& r : ramps_) {
    const Point2<Slope> at = r.building_from_ramp.inverse() * p;
    if (std::abs(at.x_m) > r.half_length_m || std::abs(at.y_m) > r.half_width_m) continue;
    const double slope = r.rise_m / (2.0 * r.half_length_m);
    return {(at.x_m + r.half_length_m) * slope, slope * r.building_from_ramp.cos_yaw(),
            slope * r.building_from_ramp.sin_yaw()};
  }
  return {};
}

}  // namespace madori::simulation
