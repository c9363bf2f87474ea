#include "localization/placement/free_ways.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "localization/placement/wall_piece.hpp"

namespace madori::localization {
namespace {

constexpr std::size_t kBeams = 600;  // more tell no more: neighbours cross the same walls
constexpr double kBeforeEndM = 0.5;  // of a beam: its own wall may be drawn that much beside its place
constexpr double kBesideM = 0.5;     // a way has to leave a wall this far behind to have crossed it,
constexpr double kAwayM = 0.25;      // and be this far from it by then: what runs along a wall says nothing
constexpr double kAsideM = 0.08;     // what passes a wall's end so near may pass beside it
constexpr int kFewestWays = 2;       // one beam alone may be a wrong point
constexpr double kMissingWalls = 0.15;  // of the walls that are drawn: they are not there

/// Whether a wall goes on to both sides of where a way meets it: one that merely grazes a wall's end, a
/// door's jamb, is off by the pose's error.
bool goes_on_aside(const mapping::DistanceField& drawn, const Point2<Map>& met, double dx, double dy) {
  const auto is_blocked = [&](double aside_m) {
    const Point2<Map> before{met.x_m - kBesideM * dx - aside_m * dy, met.y_m - kBesideM * dy + aside_m * dx};
    return drawn.free_way_m(before, dx, dy, 2.0 * kBesideM) < 2.0 * kBesideM;
  };
  return is_blocked(kAsideM) && is_blocked(-kAsideM);
}

/// Calls crossed(place) for each drawn wall that the way passes through, from well before to well behind it.
template <class Crossed>
void walk(const Segment2<Map>& way, const mapping::DistanceField& drawn, Crossed&& crossed) {
  const double length = way.length_m();
  if (length < 2.0 * kBesideM) return;
  const double dx = (way.b.x_m - way.a.x_m) / length;
  const double dy = (way.b.y_m - way.a.y_m) / length;
  const auto at = [&](double t) { return Point2<Map>{way.a.x_m + dx * t, way.a.y_m + dy * t}; };
  for (double from = 0.0; from < length - kBesideM;) {
    const double met = from + drawn.free_way_m(at(from), dx, dy, length - from);
    if (met >= length - kBesideM) return;
    if (met >= kBesideM && drawn.distance_m(at(met - kBesideM)) > kAwayM &&
        drawn.distance_m(at(met + kBesideM)) > kAwayM && goes_on_aside(drawn, at(met), dx, dy))
      crossed(at(met));
    from = met + kBesideM;
  }
}

/// The keyframe from which the vehicle drove straight to keyframe `k`, a wall's neighbourhood away.
std::optional<std::size_t> straight_drive_to(const Memory& memory, std::size_t k) {
  constexpr double kLongM = 3.0 * kBesideM;
  constexpr double kDetour = 1.05;
  for (std::size_t i = k; i-- > 0;) {
    const double way_m = memory.keyframes()[k].path_m - memory.keyframes()[i].path_m;
    const double straight_m = distance_m(memory.poses()[i].translation(), memory.poses()[k].translation());
    if (way_m > kDetour * straight_m + 0.05 || way_m > 2.0 * kLongM) return std::nullopt;
    if (straight_m > kLongM) return i;
  }
  return std::nullopt;
}

}  // namespace

FreeWays free_ways(const Memory& memory) {
  FreeWays ways;
  std::size_t points = 0;
  for (const Keyframe& keyframe : memory.keyframes()) points += keyframe.scan->points.size();
  const std::size_t stride = points / kBeams + 1;
  std::size_t next = 0;
  for (std::size_t k = 0; k < memory.size(); ++k) {
    const SurfaceScan& scan = *memory.keyframes()[k].scan;
    const Transform2<Map, Base>& pose = memory.poses()[k];
    const Point2<Map> from = pose * scan.sensor;
    for (; next < scan.points.size(); next += stride) {
      const Point2<Map> end = pose * Point2<Base>{scan.points[next].x_m, scan.points[next].y_m};
      const double length = distance_m(from, end);
      if (length <= kBeforeEndM) continue;
      const double share = (length - kBeforeEndM) / length;
      ways.beams.push_back(
          {from, {from.x_m + share * (end.x_m - from.x_m), from.y_m + share * (end.y_m - from.y_m)}});
    }
    next -= scan.points.size();
    if (const auto begin = straight_drive_to(memory, k))
      ways.driven.push_back({memory.poses()[*begin].translation(), pose.translation()});
  }
  return ways;
}

double nats_of_crossed_walls(const FreeWays& ways, const Transform2<Map, Map>& correction,
                             const mapping::DistanceField& drawn, const WallIndex& walls) {
  struct Piece {
    int ways = 0;
    double probability = 0.0;
  };
  std::unordered_map<std::uint64_t, Piece> pieces;
  const auto cross = [&](const Segment2<Map>& way, int counts) {
    walk({correction * way.a, correction * way.b}, drawn, [&](const Point2<Map>& p) {
      Piece& piece = pieces[wall_piece_of(p.x_m, p.y_m)];
      piece.ways += counts;
      piece.probability = std::max(piece.probability, walls.nearest(p.x_m, p.y_m).probability);
    });
  };
  for (const auto& beam : ways.beams) cross(beam, 1);
  for (const auto& drive : ways.driven) cross(drive, kFewestWays);
  double nats = 0.0;
  for (const auto& [place, piece] : pieces)
    if (piece.ways >= kFewestWays) nats -= std::log(1.0 - piece.probability * (1.0 - kMissingWalls));
  return nats;
}

}  // namespace madori::localization
