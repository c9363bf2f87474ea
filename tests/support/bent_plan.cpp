#include "tests/support/bent_plan.hpp"

#include <algorithm>
#include <cmath>

namespace madori::test {
namespace {

constexpr double kNodeSpacingM = 3.0;

using Engine = std::mt19937;
double between(double low, double high, Engine& engine) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}
bool chance(double share, Engine& engine) {
  return between(0.0, 1.0, engine) < share;
}

/// Free floor is outside; counter-clockwise, so that it is to the right.
PlanPart box(double x1, double y1, double x2, double y2, int room) {
  const auto [left, right] = std::minmax(x1, x2);
  const auto [low, high] = std::minmax(y1, y2);
  const Point2<Map> a{left, low};
  const Point2<Map> b{right, low};
  const Point2<Map> c{right, high};
  const Point2<Map> d{left, high};
  return {{{a, b}, {b, c}, {c, d}, {d, a}}, room};
}

/// The inner faces of the outer walls, four parts; the floor is inside.
void add_outer_walls(Plan& plan) {
  const Point2<Map> a{0.0, 0.0};
  const Point2<Map> b{plan.width_m, 0.0};
  const Point2<Map> c{plan.width_m, plan.height_m};
  const Point2<Map> d{0.0, plan.height_m};
  for (const Segment2<Map>& s : {Segment2<Map>{b, a}, {c, b}, {d, c}, {a, d}})
    plan.parts.push_back({{s}, -1});
}

using Gaps = std::vector<std::pair<double, double>>;

/// A place in a row of rooms: `along` the outer wall, `deep` from it into the building.
struct Side {
  int turn = 0;  ///< 0 the lower, 1 the left, 2 the upper, 3 the right side
  double width_m = 0.0;
  double height_m = 0.0;

  [[nodiscard]] Point2<Map> at(double along, double deep) const {
    switch (turn) {
      case 0:
        return {along, deep};
      case 1:
        return {deep, along};
      case 2:
        return {width_m - along, height_m - deep};
      default:
        return {width_m - deep, height_m - along};
    }
  }
};

/// A wall of thickness `thick` between two depths or two places along, cut by gaps: each piece a part with
/// two faces and two ends; one without thickness a line.
void add_wall_along(Plan& plan, const Side& side, double from, double to, double deep, double thick,
                    const Gaps& gaps, int room) {
  double start = from;
  const auto add = [&](double end) {
    if (end - start < 0.1) return;
    const Point2<Map> p = side.at(start, deep - 0.5 * thick);
    const Point2<Map> q = side.at(end, deep + 0.5 * thick);
    if (thick > 0.0)
      plan.parts.push_back(box(p.x_m, p.y_m, q.x_m, q.y_m, room));
    else
      plan.parts.push_back({{{p, q}}, room});
  };
  for (const auto& [first, last] : gaps) {
    add(first);
    start = last;
  }
  add(to);
}

void add_wall_across(Plan& plan, const Side& side, double along, double from, double to, double thick,
                     int room) {
  const Point2<Map> p = side.at(along - 0.5 * thick, from);
  const Point2<Map> q = side.at(along + 0.5 * thick, to);
  if (thick > 0.0)
    plan.parts.push_back(box(p.x_m, p.y_m, q.x_m, q.y_m, room));
  else
    plan.parts.push_back({{{p, q}}, room});
}

/// A row of rooms: where it is divided, its doors, and which divisions are mere lines.
struct Row {
  std::vector<double> divisions;
  Gaps doors;
  std::vector<bool> thin;
};

Row random_row(double from, double to, Engine& engine) {
  Row row;
  double at = from;
  while (to - at > 3.2) {
    double end = at + between(3.0, 6.5, engine);
    if (to - end < 3.0) end = to;
    const double wide = between(0.9, 1.2, engine);
    const double door = between(at + 0.5, end - 0.5 - wide, engine);
    row.doors.emplace_back(door, door + wide);
    if (end < to) {
      row.divisions.push_back(end);
      row.thin.push_back(chance(0.2, engine));
    }
    at = end;
  }
  return row;
}

/// Rooms between two depths; the wall with the doors is at `door_deep`.
void add_row(Plan& plan, const Side& side, const Row& row, double from, double to, double outer_deep,
             double door_deep, double thick) {
  add_wall_along(plan, side, from, to, door_deep, thick, row.doors, -1);
  for (std::size_t i = 0; i < row.divisions.size(); ++i)
    add_wall_across(plan, side, row.divisions[i], std::min(outer_deep, door_deep),
                    std::max(outer_deep, door_deep), row.thin[i] ? 0.0 : thick, plan.rooms++);
}

/// Nodes on a closed way through `corners`, neighbours joined, the lap all around.
void add_ring(Plan& plan, const std::vector<Point2<Map>>& corners) {
  const std::size_t first = plan.nodes.size();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2<Map>& a = corners[i];
    const Point2<Map>& b = corners[(i + 1) % corners.size()];
    const int steps = std::max(1, static_cast<int>(std::ceil(distance_m(a, b) / kNodeSpacingM)));
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      plan.nodes.push_back({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
    }
  }
  for (std::size_t n = first; n < plan.nodes.size(); ++n) {
    plan.legs.emplace_back(n, n + 1 < plan.nodes.size() ? n + 1 : first);
    plan.lap.push_back(n);
  }
  plan.lap.push_back(first);
}

Plan office(bool symmetric, Engine& engine) {
  Plan plan;
  plan.width_m = between(42.0, 54.0, engine);
  plan.height_m = between(28.0, 34.0, engine);
  const double deep = between(4.0, 5.5, engine);
  const double corridor = between(2.3, 2.8, engine);
  const double thick = between(0.12, 0.22, engine);
  const double inner = deep + corridor;
  add_outer_walls(plan);
  const double w = plan.width_m;
  const double h = plan.height_m;
  const Row low = random_row(0.0, w, engine);
  const Row left = random_row(deep, h - deep, engine);
  const Row core_low = random_row(inner, w - inner, engine);
  const Row high = symmetric ? low : random_row(0.0, w, engine);
  const Row right = symmetric ? left : random_row(deep, h - deep, engine);
  const Row core_high = symmetric ? core_low : random_row(inner, w - inner, engine);
  add_row(plan, {0, w, h}, low, 0.0, w, 0.0, deep, thick);
  add_row(plan, {2, w, h}, high, 0.0, w, 0.0, deep, thick);
  add_row(plan, {1, w, h}, left, deep, h - deep, 0.0, deep, thick);
  add_row(plan, {3, w, h}, right, deep, h - deep, 0.0, deep, thick);
  add_row(plan, {0, w, h}, core_low, inner, w - inner, 0.5 * h, inner, thick);
  add_row(plan, {2, w, h}, core_high, inner, w - inner, 0.5 * h, inner, thick);
  add_wall_along(plan, {0, w, h}, inner, w - inner, 0.5 * h, thick, {}, -1);
  add_wall_along(plan, {1, w, h}, inner, h - inner, inner, thick, {}, -1);
  add_wall_along(plan, {3, w, h}, inner, h - inner, inner, thick, {}, -1);
  const double mid = deep + 0.5 * corridor;
  add_ring(plan, {{mid, mid}, {w - mid, mid}, {w - mid, h - mid}, {mid, h - mid}});
  return plan;
}

/// A rack in bays and, in the gap across the hall, none; half of them with columns at the ends.
void add_rack(Plan& plan, double x, double y1, double y2, double thick, Engine& engine) {
  const double bay = between(2.5, 5.0, engine);
  const int room = plan.rooms++;
  plan.parts.push_back(box(x, y1, x + thick, y2, room));
  for (double y = y1 + bay; y < y2 - 1.0; y += bay)  // uprights stand out a little on both sides
    plan.parts.push_back(box(x - 0.08, y, x + thick + 0.08, y + 0.16, room));
}

Plan hall(bool symmetric, Engine& engine) {
  Plan plan;
  const int aisles = 2 * std::uniform_int_distribution<int>(2, 3)(engine);
  const double thick = between(1.0, 2.4, engine);
  const double aisle = between(2.8, 3.4, engine);
  const double edge = between(3.2, 4.5, engine);
  plan.width_m = aisles * aisle + (aisles + 1) * thick;
  plan.height_m = between(24.0, 34.0, engine);
  add_outer_walls(plan);
  const double w = plan.width_m;
  const double h = plan.height_m;
  for (int i = 0; i <= aisles; ++i) {
    const double x = i * (thick + aisle);
    const double gap = symmetric ? 0.0 : between(-4.0, 4.0, engine);
    Engine same = engine;
    add_rack(plan, x, edge, 0.5 * h + gap - 1.5, thick, engine);
    add_rack(plan, x, 0.5 * h + gap + 1.5, h - edge, thick, symmetric ? same : engine);
  }
  const double pitch = between(5.0, 9.0, engine);
  for (double x = pitch; x < w - 1.0; x += pitch) {  // pilasters on the long walls
    const double deep = between(0.2, 0.4, engine);
    plan.parts.push_back(box(x, 0.0, x + 0.4, deep, -1));
    plan.parts.push_back(box(w - x - 0.4, h - deep, w - x, h, -1));
  }
  std::vector<Point2<Map>> corners;
  for (int i = 0; i < aisles; ++i) {
    const double x = thick + 0.5 * aisle + i * (thick + aisle);
    const bool up = i % 2 == 0;
    corners.push_back({x, up ? 0.5 * edge : h - 0.5 * edge});
    corners.push_back({x, up ? h - 0.5 * edge : 0.5 * edge});
  }
  if (corners.size() > 2) corners.back().y_m = 0.5 * edge;
  add_ring(plan, corners);
  return plan;
}

/// A face with recesses (doors, niches, columns), from a to b with the floor to the right.
void add_face(Plan& plan, const Point2<Map>& a, const Point2<Map>& b, Engine& engine) {
  const double length = distance_m(a, b);
  const double ux = (b.x_m - a.x_m) / length;
  const double uy = (b.y_m - a.y_m) / length;
  const auto at = [&](double along, double deep) {
    return Point2<Map>{a.x_m + along * ux - deep * uy, a.y_m + along * uy + deep * ux};
  };
  double start = 0.0;
  for (double s = between(1.5, 6.0, engine); s < length - 2.5; s += between(3.0, 9.0, engine)) {
    const double wide = between(0.4, 1.2, engine);
    const double deep = chance(0.3, engine) ? -0.15 : between(0.1, 0.3, engine);
    plan.parts.push_back({{{at(start, 0.0), at(s, 0.0)}}, -1});
    plan.parts.push_back({{{at(s, 0.0), at(s, deep)},
                           {at(s, deep), at(s + wide, deep)},
                           {at(s + wide, deep), at(s + wide, 0.0)}},
                          -1});
    start = s + wide;
    s = start;
  }
  plan.parts.push_back({{{at(start, 0.0), b}}, -1});
}

Plan corridors(bool symmetric, Engine& engine) {
  Plan plan;
  const int columns = std::uniform_int_distribution<int>(2, 3)(engine);
  const double wide = between(2.4, 3.0, engine);
  const double block_x = between(13.0, 20.0, engine);
  const double block_y = between(9.0, 14.0, engine);
  plan.width_m = columns * block_x + (columns + 1) * wide;
  plan.height_m = 2.0 * block_y + 3.0 * wide;
  const double w = plan.width_m;
  const double h = plan.height_m;
  const auto turned = [&](const Point2<Map>& p, bool half) {
    return half ? Point2<Map>{w - p.x_m, h - p.y_m} : p;
  };
  const auto seed = static_cast<std::uint32_t>(engine());
  for (const bool half : {false, true}) {  // the upper half is the lower one turned, alike or not
    Engine own(symmetric || !half ? seed : seed + 1);
    const auto face = [&](const Point2<Map>& a, const Point2<Map>& b) {
      add_face(plan, turned(a, half), turned(b, half), own);
    };
    face({w, 0.0}, {0.0, 0.0});
    face({0.0, 0.0}, {0.0, h});
    for (int i = 0; i < columns; ++i) {
      const Point2<Map> p{wide + i * (block_x + wide), wide};
      const Point2<Map> q{p.x_m + block_x, p.y_m + block_y};
      face(p, {q.x_m, p.y_m});
      face({q.x_m, p.y_m}, q);
      face(q, {p.x_m, q.y_m});
      face({p.x_m, q.y_m}, p);
    }
  }
  const double mid = 0.5 * wide;
  add_ring(plan, {{mid, mid},
                  {mid + block_x + wide, mid},
                  {mid + block_x + wide, 0.5 * h},
                  {w - mid, 0.5 * h},
                  {w - mid, h - mid},
                  {mid, h - mid}});
  return plan;
}

}  // namespace

Plan random_plan(BuildingKind kind, bool symmetric, std::mt19937& engine) {
  switch (kind) {
    case BuildingKind::Office:
      return office(symmetric, engine);
    case BuildingKind::Hall:
      return hall(symmetric, engine);
    case BuildingKind::Corridors:
      break;
  }
  return corridors(symmetric, engine);
}

}  // namespace madori::test
