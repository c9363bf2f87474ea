#include "tests/support/bent_building.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/angle.hpp"
#include "core/segment_distance.hpp"

namespace madori::test {
namespace {

using Engine = std::mt19937;
using Lines = std::vector<Segment2<Map>>;
constexpr double kPieceM = 2.0;  ///< a bent line is a chain of pieces no longer

double between(double low, double high, Engine& engine) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}

double clearance_of(const Segment2<Map>& s, const Lines& lines) {
  double nearest = 1e9;
  for (const Segment2<Map>& line : lines) nearest = std::min(nearest, distance_m(s, line));
  return nearest;
}

Lines legs_of(const Plan& plan) {
  Lines legs;
  for (const auto& [from, to] : plan.legs) legs.push_back({plan.nodes[from], plan.nodes[to]});
  return legs;
}

Lines pieces_of(const Segment2<Map>& s) {
  const int count = std::max(1, static_cast<int>(std::ceil(s.length_m() / kPieceM)));
  const auto at = [&](int k) {
    const double t = static_cast<double>(k) / count;
    return Point2<Map>{s.a.x_m + t * (s.b.x_m - s.a.x_m), s.a.y_m + t * (s.b.y_m - s.a.y_m)};
  };
  Lines pieces;
  for (int k = 0; k < count; ++k) pieces.push_back({at(k), at(k + 1)});
  return pieces;
}

void add(mapping::Walls& walls, const Segment2<Map>& s) {
  walls.push_back({static_cast<int>(walls.size()), s});
}

/// Cupboards, pallets and machines in front of a share of the walls, on the floor to the right of a -> b.
Lines furniture_of(const Plan& plan, const BentBuildingOptions& options, Engine& engine) {
  const Lines legs = legs_of(plan);
  Lines all;
  for (const PlanPart& part : plan.parts) {
    for (const Segment2<Map>& s : part.lines) {
      const double length = s.length_m();
      if (length < 1.0 || between(0.0, 1.0, engine) >= options.furniture) continue;
      const double deep = between(0.3, 0.6, engine);
      const double long_m = length * between(0.4, 0.9, engine);
      const double from = between(0.0, length - long_m, engine);
      const double ux = (s.b.x_m - s.a.x_m) / length;
      const double uy = (s.b.y_m - s.a.y_m) / length;
      const auto at = [&](double along, double off) {
        return Point2<Map>{s.a.x_m + along * ux + off * uy, s.a.y_m + along * uy - off * ux};
      };
      const Lines box{{at(from, 0.03), at(from, deep)},
                      {at(from, deep), at(from + long_m, deep)},
                      {at(from + long_m, deep), at(from + long_m, 0.03)}};
      // Bending narrows a passage by up to the strain; the field's slope is limited.
      const double least = options.clearance_m / (1.0 - options.most_strain);
      if (std::all_of(box.begin(), box.end(),
                      [&](const Segment2<Map>& line) { return clearance_of(line, legs) > least; }))
        all.insert(all.end(), box.begin(), box.end());
    }
  }
  return all;
}

/// Walls that were planned and never built, clear of the routes.
std::vector<Lines> invented_of(const Plan& plan, const BentBuildingOptions& options, Engine& engine) {
  const Lines legs = legs_of(plan);
  const auto wanted = static_cast<std::size_t>(options.invented * static_cast<double>(plan.parts.size()));
  std::vector<Lines> all;
  for (int tries = 0; all.size() < wanted && tries < 10000; ++tries) {
    const Point2<Map> p{between(0.0, plan.width_m, engine), between(0.0, plan.height_m, engine)};
    const double long_m = between(1.0, 5.0, engine);
    const bool along_x = between(0.0, 1.0, engine) < 0.5;
    const double thick = between(0.1, 0.2, engine);
    const Point2<Map> q{p.x_m + (along_x ? long_m : thick), p.y_m + (along_x ? thick : long_m)};
    const Lines box{{p, {q.x_m, p.y_m}}, {{q.x_m, p.y_m}, q}, {q, {p.x_m, q.y_m}}, {{p.x_m, q.y_m}, p}};
    const double least = options.clearance_m / (1.0 - options.most_strain);
    if (q.x_m < plan.width_m && q.y_m < plan.height_m &&
        std::all_of(box.begin(), box.end(),
                    [&](const Segment2<Map>& line) { return clearance_of(line, legs) > least; }))
      all.push_back(box);
  }
  return all;
}

/// Carries the straight plan into what is drawn and what stands: one of the two is bent.
class Bender {
 public:
  Bender(const BentBuildingOptions& options, const TrueWarp& warp) : options_(options), warp_(warp) {}

  [[nodiscard]] Point2<Map> drawn(const Point2<Map>& p) const {
    return options_.straight_drawing ? p : warp_.map({p.x_m, p.y_m});
  }
  [[nodiscard]] Point2<Map> standing(const Point2<Map>& p) const {
    if (!options_.straight_drawing) return p;
    const Point2<Building> q = warp_.building(p);
    return {q.x_m, q.y_m};
  }

 private:
  const BentBuildingOptions& options_;
  const TrueWarp& warp_;
};

Point2<Map> shifted(const Point2<Map>& p, const Point2<Map>& by) {
  return {p.x_m + by.x_m, p.y_m + by.y_m};
}

planning::RouteGraph routes_of(const Plan& plan, const Bender& bender) {
  std::vector<planning::RouteNode> nodes(plan.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].id = static_cast<int>(i) + 1;
    nodes[i].position = bender.drawn(plan.nodes[i]);
    nodes[i].station = i % 8 == 0;
  }
  std::vector<planning::RouteLeg> legs;
  for (const auto& [from, to] : plan.legs) {
    legs.push_back({from, to, 0.0, 0});
    legs.push_back({to, from, 0.0, 0});
  }
  return {std::move(nodes), std::move(legs)};
}

void draw_walls(BentBuilding& made, const Plan& plan, const Bender& bender, Engine& engine) {
  std::normal_distribution<double> normal;
  std::vector<Point2<Map>> shifts(static_cast<std::size_t>(plan.rooms));
  for (Point2<Map>& s : shifts) {
    const double most = 1.5 * made.options.room_sigma_m;  // so that passages stay passages
    s.x_m = std::clamp(made.options.room_sigma_m * normal(engine), -most, most);
    s.y_m = std::clamp(made.options.room_sigma_m * normal(engine), -most, most);
  }
  for (const PlanPart& part : plan.parts) {
    const bool is_drawn = between(0.0, 1.0, engine) >= made.options.missing;
    const Point2<Map> by = part.room < 0 ? Point2<Map>{} : shifts[static_cast<std::size_t>(part.room)];
    for (const Segment2<Map>& line : part.lines) {
      const Lines pieces = pieces_of(line);
      for (const Segment2<Map>& s : pieces) add(made.truth, {bender.standing(s.a), bender.standing(s.b)});
      if (!is_drawn) continue;
      const Lines whole{line};
      for (const Segment2<Map>& s : made.options.straight_drawing ? whole : pieces) {
        add(made.drawn, {shifted(bender.drawn(s.a), by), shifted(bender.drawn(s.b), by)});
        made.drawn_walls.push_back({false, by});
      }
    }
  }
  for (const Lines& lines : invented_of(plan, made.options, engine)) {
    for (const Segment2<Map>& s : lines) {
      add(made.drawn, {bender.drawn(s.a), bender.drawn(s.b)});
      made.drawn_walls.push_back({true, {}});
    }
  }
}

}  // namespace

TrueWarp::TrueWarp(const BentBuildingOptions& options, double width_m, double height_m, std::uint32_t seed)
    : scale_(options.scale), direct_to_building_(options.straight_drawing) {
  constexpr int kWaves = 14;
  Engine engine(seed);
  std::normal_distribution<double> normal;
  for (int i = 0; i < kWaves; ++i) {
    const double length = options.shortest_wave_m * std::pow(options.longest_wave_m / options.shortest_wave_m,
                                                             between(0.0, 1.0, engine));
    const double turn = between(-kPi, kPi, engine);
    const double k = 2.0 * kPi / length;
    waves_.push_back({k * std::cos(turn), k * std::sin(turn), between(-kPi, kPi, engine),
                      length * normal(engine), length * normal(engine)});
  }
  normalize(options, width_m, height_m);
}

void TrueWarp::normalize(const BentBuildingOptions& options, double width_m, double height_m) {
  constexpr double kStepM = 0.5;
  std::sort(waves_.begin(), waves_.end(),
            [](const Wave& a, const Wave& b) { return std::hypot(a.kx, a.ky) < std::hypot(b.kx, b.ky); });
  for (;;) {
    largest_m_ = 0.0;
    most_strain_ = 0.0;
    for (double y = 0.0; y <= height_m; y += kStepM) {
      for (double x = 0.0; x <= width_m; x += kStepM) {
        const Point2<Map> here = shift(x, y);
        const Point2<Map> right = shift(x + 0.1, y);
        const Point2<Map> up = shift(x, y + 0.1);
        largest_m_ = std::max(largest_m_, std::hypot(here.x_m, here.y_m));
        most_strain_ = std::max({most_strain_, 10.0 * distance_m(here, right), 10.0 * distance_m(here, up)});
      }
    }
    const double factor = options.amplitude_m / std::max(1e-9, largest_m_);
    if (factor * most_strain_ <= options.most_strain || waves_.size() == 1) {
      for (Wave& w : waves_) {
        w.ax *= factor;
        w.ay *= factor;
      }
      largest_m_ *= factor;
      most_strain_ *= factor;
      return;
    }
    waves_.pop_back();
  }
}

Point2<Map> TrueWarp::shift(double x_m, double y_m) const {
  Point2<Map> sum;
  for (const Wave& w : waves_) {
    const double wave = std::sin(w.kx * x_m + w.ky * y_m + w.phase);
    sum.x_m += w.ax * wave;
    sum.y_m += w.ay * wave;
  }
  return sum;
}

Point2<Building> TrueWarp::building(const Point2<Map>& p) const {
  const Point2<Map> metric{p.x_m / scale_, p.y_m / scale_};
  if (direct_to_building_) {
    const Point2<Map> by = shift(metric.x_m, metric.y_m);
    return {metric.x_m + by.x_m, metric.y_m + by.y_m};
  }
  Point2<Map> q = metric;
  for (int i = 0; i < 60; ++i) {
    const Point2<Map> by = shift(q.x_m, q.y_m);
    q = {metric.x_m - by.x_m, metric.y_m - by.y_m};
  }
  return {q.x_m, q.y_m};
}

Point2<Map> TrueWarp::map(const Point2<Building>& p) const {
  Point2<Map> q{p.x_m, p.y_m};
  if (direct_to_building_) {
    for (int i = 0; i < 60; ++i) {
      const Point2<Map> by = shift(q.x_m, q.y_m);
      q = {p.x_m - by.x_m, p.y_m - by.y_m};
    }
  } else {
    q = shifted(q, shift(p.x_m, p.y_m));
  }
  return {scale_ * q.x_m, scale_ * q.y_m};
}

BentBuildingOptions hard_building(std::uint32_t seed, double amplitude_m) {
  Engine engine(seed * 7919U + 17U);
  BentBuildingOptions options;
  options.seed = seed;
  options.kind = static_cast<BuildingKind>(seed % 3);
  options.symmetric = between(0.0, 1.0, engine) < 0.25;
  options.straight_drawing = between(0.0, 1.0, engine) < 0.5;
  options.amplitude_m = amplitude_m;
  options.scale = between(0.98, 1.02, engine);
  options.room_sigma_m = between(0.0, 0.3, engine);
  options.missing = 0.15;
  options.invented = 0.10;
  options.furniture = between(0.0, 0.4, engine);
  return options;
}

BentBuilding bent_building(const BentBuildingOptions& options) {
  Engine engine(options.seed);
  const Plan plan = random_plan(options.kind, options.symmetric, engine);
  BentBuilding made;
  made.options = options;
  made.width_m = plan.width_m;
  made.height_m = plan.height_m;
  made.warp = std::make_shared<const TrueWarp>(options, plan.width_m, plan.height_m,
                                               static_cast<std::uint32_t>(engine()));
  const Bender bender(options, *made.warp);
  draw_walls(made, plan, bender, engine);
  for (const Segment2<Map>& s : furniture_of(plan, options, engine)) {
    const Segment2<Map> standing{bender.standing(s.a), bender.standing(s.b)};
    add(made.truth, standing);
    add(made.furniture, standing);
  }
  made.routes = routes_of(plan, bender);
  made.lap = plan.lap;
  return made;
}

std::vector<Point2<Map>> along_lap(const BentBuilding& building, double step_m, double metres) {
  std::vector<Point2<Map>> points;
  const auto& nodes = building.routes.nodes();
  double rest = 0.0;
  double driven = 0.0;
  for (std::size_t i = 0; driven < metres; i = (i + 1) % (building.lap.size() - 1)) {
    const Point2<Map>& a = nodes[building.lap[i]].position;
    const Point2<Map>& b = nodes[building.lap[i + 1]].position;
    const double length = distance_m(a, b);
    double s = rest;
    for (; s < length && driven + s < metres; s += step_m)
      points.push_back({a.x_m + s / length * (b.x_m - a.x_m), a.y_m + s / length * (b.y_m - a.y_m)});
    rest = s - length;
    driven += length;
  }
  return points;
}

}  // namespace madori::test
