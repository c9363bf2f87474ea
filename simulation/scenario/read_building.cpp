#include "simulation/scenario/reading.hpp"

namespace madori::simulation {

using mapping::StrictYaml;

namespace {

Point2<Plan> point_of(const StrictYaml& yaml, const std::string& key, const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 2) throw yaml.error(key, "is no [x, y]", "write two numbers");
  try {
    const Point2<Plan> p{node[0].as<double>(), node[1].as<double>()};
    if (std::abs(p.x_m) <= kFarM && std::abs(p.y_m) <= kFarM) return p;
  } catch (const YAML::BadConversion&) {
    throw yaml.error(key, "is no [x, y]", "write two numbers");
  }
  throw yaml.error(key, "lies outside of +-100 km", "");
}

constexpr double kLargestM = 500.0;

}  // namespace

Point2<Plan> read_point(StrictYaml& yaml, const std::string& key) {
  const YAML::Node node = yaml.raw(key);
  if (!node) throw yaml.error(key, "is missing", "add [x, y]");
  return point_of(yaml, key, node);
}

std::vector<Point2<Plan>> read_points(StrictYaml& yaml, const std::string& key, std::size_t least) {
  const YAML::Node node = yaml.raw(key);
  std::vector<Point2<Plan>> points;
  if (node && !node.IsSequence()) throw yaml.error(key, "is no list of [x, y]", "");
  if (node)
    for (const auto& item : node) points.push_back(point_of(yaml, key, item));
  if (points.size() < least) throw yaml.error(key, "needs " + std::to_string(least) + " points or more", "");
  return points;
}

Segment2<Plan> read_line(StrictYaml& yaml, const std::string& key) {
  const auto points = read_points(yaml, key, 2);
  if (points.size() != 2 || points[0] == points[1])
    throw yaml.error(key, "is no line", "write two different points");
  return {points[0], points[1]};
}

std::vector<int> read_ids(StrictYaml& yaml, const std::string& key) {
  const YAML::Node node = yaml.raw(key);
  if (!node) return {};
  try {
    return node.as<std::vector<int>>();
  } catch (const YAML::BadConversion&) {
    throw yaml.error(key, "is no list of wall numbers", "take them from walls.csv");
  }
}

BuildingSpec read_building(StrictYaml yaml, const std::filesystem::path& folder) {
  BuildingSpec b;
  const std::string walls = yaml.text_or("walls", "");
  if (!walls.empty()) b.walls_file = folder / walls;
  b.wall_height_m = yaml.number_or("wall_height_m", b.wall_height_m, 0.1, 100.0);
  b.ceiling_height_m = yaml.number_or("ceiling_height_m", b.ceiling_height_m, 0.1, 100.0);
  b.scale_error_x_percent = yaml.number_or("scale_error_x_percent", 0.0, -20.0, 20.0);
  b.scale_error_y_percent = yaml.number_or("scale_error_y_percent", 0.0, -20.0, 20.0);
  b.missing_walls = read_ids(yaml, "missing_walls");
  for (StrictYaml& item : yaml.list("moved_walls")) {
    MovedWalls moved{read_ids(item, "ids"), item.number_or("dx_m", 0.0, -100.0, 100.0),
                     item.number_or("dy_m", 0.0, -100.0, 100.0)};
    item.refuse_unknown_keys();
    b.moved_walls.push_back(moved);
  }
  for (StrictYaml& item : yaml.list("added_walls")) {
    b.added_walls.push_back(read_line(item, "line"));
    item.refuse_unknown_keys();
  }
  yaml.refuse_unknown_keys();
  return b;
}

SolidSpec read_solid(StrictYaml& yaml) {
  SolidSpec s;
  s.kind = read_word<SolidKind>(yaml, "kind",
                                {{"machine", SolidKind::Machine},
                                 {"shelf", SolidKind::Shelf},
                                 {"pallet", SolidKind::Pallet},
                                 {"pillar", SolidKind::Pillar},
                                 {"desk", SolidKind::Desk},
                                 {"clutter", SolidKind::Clutter}});
  s.name = yaml.text_or("name", yaml.text("kind"));
  s.centre = read_point(yaml, "centre");
  s.yaw_deg = yaml.number_or("yaw_deg", 0.0, -360.0, 360.0);
  s.length_m = yaml.number("length_m", 0.01, kLargestM);
  s.width_m = yaml.number("width_m", 0.01, kLargestM);
  s.height_m = yaml.number("height_m", 0.01, 100.0);
  yaml.refuse_unknown_keys();
  return s;
}

OfficeSpec read_office(StrictYaml& yaml) {
  OfficeSpec o;
  o.name = yaml.text_or("name", "office");
  o.centre = read_point(yaml, "centre");
  o.yaw_deg = yaml.number_or("yaw_deg", 0.0, -360.0, 360.0);
  o.length_m = yaml.number_or("length_m", o.length_m, 0.5, kLargestM);
  o.width_m = yaml.number_or("width_m", o.width_m, 0.5, kLargestM);
  o.height_m = yaml.number_or("height_m", o.height_m, 0.5, 100.0);
  o.doorway_m = yaml.number_or("doorway_m", o.doorway_m, 0.0, o.length_m);
  yaml.refuse_unknown_keys();
  return o;
}

GlassSpec read_glass(StrictYaml& yaml) {
  GlassSpec g;
  g.line = read_line(yaml, "line");
  g.low_m = yaml.number_or("low_m", g.low_m, 0.0, 100.0);
  g.high_m = yaml.number_or("high_m", g.high_m, 0.0, 100.0);
  if (g.high_m <= g.low_m) throw yaml.error("high_m", "must be more than low_m", "");
  yaml.refuse_unknown_keys();
  return g;
}

RampSpec read_ramp(StrictYaml& yaml) {
  RampSpec r;
  r.centre = read_point(yaml, "centre");
  r.yaw_deg = yaml.number_or("yaw_deg", 0.0, -360.0, 360.0);
  r.length_m = yaml.number_or("length_m", r.length_m, 0.5, 100.0);
  r.width_m = yaml.number_or("width_m", r.width_m, 0.5, 100.0);
  r.rise_m = yaml.number_or("rise_m", r.rise_m, 0.0, 0.3 * r.length_m);
  yaml.refuse_unknown_keys();
  return r;
}

FurnitureSpec read_furniture(StrictYaml yaml) {
  FurnitureSpec f;
  f.day = yaml.integer_or("day", f.day, 0, 1'000'000);
  f.count = yaml.integer_or("count", f.count, 0, 10'000);
  f.hide_walls_percent = yaml.number_or("hide_walls_percent", 0.0, 0.0, 90.0);
  f.clutter_height_m = yaml.number_or("clutter_height_m", f.clutter_height_m, 0.1, 100.0);
  f.keep_clear_m = yaml.number_or("keep_clear_m", f.keep_clear_m, 0.0, 100.0);
  for (StrictYaml& item : yaml.list("keep_clear")) {
    f.keep_clear.push_back(read_points(item, "line", 1));
    item.refuse_unknown_keys();
  }
  yaml.refuse_unknown_keys();
  return f;
}

}  // namespace madori::simulation
