#include "simulation/scenario/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/random.hpp"

namespace madori::simulation {
namespace {

constexpr std::uint64_t kStream = 0xF00D;
constexpr double kPieceM = 1.5;  ///< of wall that one heap of clutter hides

double distance_to(const Segment2<Plan>& s, const Point2<Plan>& p) {
  const double ux = s.b.x_m - s.a.x_m, uy = s.b.y_m - s.a.y_m, uu = ux * ux + uy * uy;
  const double t =
      uu > 0.0 ? std::clamp(((p.x_m - s.a.x_m) * ux + (p.y_m - s.a.y_m) * uy) / uu, 0.0, 1.0) : 0.0;
  return std::hypot(s.a.x_m + t * ux - p.x_m, s.a.y_m + t * uy - p.y_m);
}

bool is_clear(const Scenario& s, const Point2<Plan>& p, double reach_m) {
  const double least = s.furniture.keep_clear_m + reach_m;
  if (distance_m(s.start.translation(), p) < least) return false;
  for (const auto& line : s.furniture.keep_clear) {
    if (line.size() == 1 && distance_m(line[0], p) < least) return false;
    for (std::size_t i = 1; i < line.size(); ++i)
      if (distance_to({line[i - 1], line[i]}, p) < least) return false;
  }
  return true;
}

std::vector<Segment2<Plan>> pieces_of(const std::vector<Segment2<Plan>>& walls) {
  std::vector<Segment2<Plan>> pieces;
  for (const auto& w : walls) {
    const int count = std::max(1, static_cast<int>(std::lround(w.length_m() / kPieceM)));
    const auto at = [&](int i) {
      const double t = static_cast<double>(i) / count;
      return Point2<Plan>{w.a.x_m + t * (w.b.x_m - w.a.x_m), w.a.y_m + t * (w.b.y_m - w.a.y_m)};
    };
    for (int i = 0; i < count; ++i) pieces.push_back({at(i), at(i + 1)});
  }
  return pieces;
}

void hide_walls(const std::vector<Segment2<Plan>>& walls, const Scenario& s, Random& random,
                std::vector<SolidSpec>& out) {
  auto pieces = pieces_of(walls);
  double total = 0.0, hidden = 0.0;
  for (const auto& p : pieces) total += p.length_m();
  for (std::size_t i = pieces.size(); i > 1; --i) std::swap(pieces[i - 1], pieces[random.below(i)]);
  for (const auto& p : pieces) {
    if (hidden >= total * s.furniture.hide_walls_percent / 100.0) break;
    const double depth = random.uniform(0.4, 1.0), height = random.uniform(0.7, 1.0);
    SolidSpec heap;
    heap.kind = SolidKind::Clutter;
    heap.name = "clutter";
    heap.centre = {(p.a.x_m + p.b.x_m) / 2.0, (p.a.y_m + p.b.y_m) / 2.0};
    heap.yaw_deg = to_deg(std::atan2(p.b.y_m - p.a.y_m, p.b.x_m - p.a.x_m));
    heap.length_m = p.length_m();
    heap.width_m = depth;  // on both sides: which one is the room's is not drawn
    heap.height_m = s.furniture.clutter_height_m * height;
    if (heap.length_m < 0.05 || !is_clear(s, heap.centre, std::hypot(heap.length_m, depth) / 2.0)) continue;
    hidden += p.length_m();
    out.push_back(heap);
  }
}

void place_pallets(const std::vector<Segment2<Plan>>& walls, const Scenario& s, Random& random,
                   std::vector<SolidSpec>& out) {
  if (walls.empty()) return;
  Point2<Plan> low = walls[0].a, high = low;
  for (const auto& w : walls) {
    low = {std::min({low.x_m, w.a.x_m, w.b.x_m}), std::min({low.y_m, w.a.y_m, w.b.y_m})};
    high = {std::max({high.x_m, w.a.x_m, w.b.x_m}), std::max({high.y_m, w.a.y_m, w.b.y_m})};
  }
  int left = s.furniture.count;
  for (int attempt = 0; left > 0 && attempt < 50 * s.furniture.count; ++attempt) {
    SolidSpec pallet;
    pallet.kind = SolidKind::Pallet;
    pallet.name = "pallet";
    pallet.length_m = 1.2;
    pallet.width_m = 0.8;
    pallet.centre = {random.uniform(low.x_m, high.x_m), random.uniform(low.y_m, high.y_m)};
    pallet.yaw_deg = random.uniform(0.0, 180.0);
    pallet.height_m = random.uniform(0.3, 1.6);
    const bool in_wall = std::any_of(walls.begin(), walls.end(),
                                     [&](const auto& w) { return distance_to(w, pallet.centre) < 0.8; });
    if (in_wall || !is_clear(s, pallet.centre, 0.75)) continue;
    out.push_back(pallet);
    --left;
  }
}

}  // namespace

std::vector<SolidSpec> place_furniture(const std::vector<Segment2<Plan>>& walls, const Scenario& scenario) {
  Random random(scenario.seed, kStream, static_cast<std::uint64_t>(scenario.furniture.day));
  std::vector<SolidSpec> placed;
  hide_walls(walls, scenario, random, placed);
  place_pallets(walls, scenario, random, placed);
  return placed;
}

}  // namespace madori::simulation
