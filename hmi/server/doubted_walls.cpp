#include "hmi/server/doubted_walls.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/wall_map/grid_frame.hpp"

namespace madori::hmi {
namespace {

using Segment = Segment2<Map>;

constexpr double kOn_m = 0.05;       // a piece lies on a stretch that was answered for: both are of one line
constexpr double kThickest_m = 0.6;  // from one face of a wall to the other, masonry included
constexpr double kParallel = 0.985;  // cosine of 10 degrees
constexpr double kAlongShare = 0.5;  // of the shorter face that must lie beside the longer one

struct Stretch {
  int wall = 0;
  int last_piece = 0;
  Segment segment;
  double missed = 0.0;
};

bool is_answered(const Segment& piece, const std::vector<Segment>& standing) {
  const Point2<Map> middle{0.5 * (piece.a.x_m + piece.b.x_m), 0.5 * (piece.a.y_m + piece.b.y_m)};
  return std::any_of(standing.begin(), standing.end(), [&](const Segment& s) {
    return mapping::squared_distance_m2(s, middle) < kOn_m * kOn_m;
  });
}

std::vector<Stretch> stretches(const std::vector<WallView>& pieces, const std::vector<Segment>& standing) {
  std::vector<Stretch> all;
  for (const WallView& p : pieces) {
    if (!p.surely_missing || is_answered(p.segment, standing)) continue;
    if (!all.empty() && all.back().wall == p.id && all.back().last_piece + 1 == p.piece) {
      Stretch& grown = all.back();
      grown.last_piece = p.piece;
      grown.segment.b = p.segment.b;
      grown.missed = std::min(grown.missed, p.missed);
    } else {
      all.push_back({p.id, p.piece, p.segment, p.missed});
    }
  }
  return all;
}

/// Whether `other` is another face of the wall that `face`, which is not shorter, belongs to.
bool is_face_of(const Segment& face, const Segment& other) {
  const double length = face.length_m(), other_length = other.length_m();
  if (length <= 0.0 || other_length <= 0.0) return false;
  const double ux = (face.b.x_m - face.a.x_m) / length, uy = (face.b.y_m - face.a.y_m) / length;
  const auto along = [&](const Point2<Map>& p) {
    return (p.x_m - face.a.x_m) * ux + (p.y_m - face.a.y_m) * uy;
  };
  const auto beside = [&](const Point2<Map>& p) {
    return std::abs((p.y_m - face.a.y_m) * ux - (p.x_m - face.a.x_m) * uy);
  };
  const auto [from, to] = std::minmax({along(other.a), along(other.b)});
  const double shared = std::min(to, length) - std::max(from, 0.0);
  return to - from > kParallel * other_length && shared > kAlongShare * other_length &&
         std::max(beside(other.a), beside(other.b)) < kThickest_m;
}

}  // namespace

std::vector<DoubtedWall> doubted_walls(const std::vector<WallView>& pieces,
                                       const std::vector<Segment>& standing) {
  auto left = stretches(pieces, standing);
  std::ranges::stable_sort(left, std::greater<>(), [](const Stretch& s) { return s.segment.length_m(); });
  std::vector<DoubtedWall> walls;
  for (const Stretch& s : left) {
    const auto same = std::ranges::find_if(
        walls, [&](const DoubtedWall& w) { return is_face_of(w.segments.front(), s.segment); });
    if (same == walls.end()) {
      walls.push_back({{s.segment}, s.missed});
      continue;
    }
    same->segments.push_back(s.segment);
    same->missed = std::min(same->missed, s.missed);
  }
  return walls;
}

}  // namespace madori::hmi
