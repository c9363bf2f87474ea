#include "planning/detour/dubins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace madori::planning {
namespace {

/// The problem in turning radii, seen along the line from start to end.
struct Normal {
  double d, sin_a, cos_a, sin_b, cos_b, a, b;
  [[nodiscard]] double cos_difference() const { return cos_a * cos_b + sin_a * sin_b; }
};

/// From 0 to a whole turn; what rounding puts just below a whole turn is none.
double positive_turn(double angle_rad) {
  constexpr double kRounding = 1e-9;
  const double turn = angle_rad - 2.0 * kPi * std::floor(angle_rad / (2.0 * kPi));
  return turn > 2.0 * kPi - kRounding ? 0.0 : turn;
}

struct Word {
  std::array<double, 3> turns;
  std::array<double, 3> lengths;
  [[nodiscard]] double length() const { return lengths[0] + lengths[1] + lengths[2]; }
};

void keep_shorter(Word& best, const Word& word) {
  if (word.length() < best.length()) best = word;
}

/// Both arcs to the same side (`side` 1 left, -1 right) with a straight between.
void same_side(const Normal& n, double side, Word& best) {
  const double square = 2.0 + n.d * n.d - 2.0 * n.cos_difference() + side * 2.0 * n.d * (n.sin_a - n.sin_b);
  const double to = std::atan2(side * (n.cos_b - n.cos_a), n.d + side * (n.sin_a - n.sin_b));
  keep_shorter(best, {{side, 0.0, side},
                      {positive_turn(side * (to - n.a)), std::sqrt(std::max(0.0, square)),
                       positive_turn(side * (n.b - to))}});
}

/// First to `side`, straight, then to the other.
void sides_change(const Normal& n, double side, Word& best) {
  const double square = n.d * n.d - 2.0 + 2.0 * n.cos_difference() + side * 2.0 * n.d * (n.sin_a + n.sin_b);
  if (square < 0.0) return;
  const double straight = std::sqrt(square);
  const double to = std::atan2(-side * (n.cos_a + n.cos_b), n.d + side * (n.sin_a + n.sin_b)) +
                    side * std::atan2(2.0, straight);
  keep_shorter(best, {{side, 0.0, -side},
                      {positive_turn(side * (to - n.a)), straight, positive_turn(side * (to - n.b))}});
}

/// Three arcs, the outer ones to `side`.
void arcs_only(const Normal& n, double side, Word& best) {
  const double cosine =
      (6.0 - n.d * n.d + 2.0 * n.cos_difference() + side * 2.0 * n.d * (n.sin_b - n.sin_a)) / 8.0;
  if (std::abs(cosine) > 1.0) return;
  const double middle = 2.0 * kPi - std::acos(cosine);
  const double to = std::atan2(side * (n.cos_b - n.cos_a), n.d + side * (n.sin_a - n.sin_b));
  const double first = positive_turn(side * (to - n.a) + middle / 2.0);
  keep_shorter(best,
               {{side, -side, side}, {first, middle, positive_turn(side * (n.b - n.a) - first + middle)}});
}

}  // namespace

DubinsCurve shortest_dubins(const Transform2<Map, Base>& from, const Transform2<Map, Base>& to,
                            double radius_m) {
  const double dx = to.x_m() - from.x_m();
  const double dy = to.y_m() - from.y_m();
  const double line = std::atan2(dy, dx);
  const double a = from.yaw_rad() - line;
  const double b = to.yaw_rad() - line;
  const Normal n{std::hypot(dx, dy) / radius_m, std::sin(a), std::cos(a), std::sin(b), std::cos(b), a, b};
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Word best{{}, {kNone, kNone, kNone}};
  for (const double side : {1.0, -1.0}) {
    same_side(n, side, best);
    sides_change(n, side, best);
    arcs_only(n, side, best);
  }
  DubinsCurve curve{from, radius_m, {}};
  for (std::size_t i = 0; i < 3; ++i) curve.pieces[i] = {best.turns[i], best.lengths[i]};
  return curve;
}

Transform2<Map, Base> DubinsCurve::pose_at(double along_m) const {
  Transform2<Map, Base> pose = start;
  double left = along_m / radius_m;
  for (const Piece& piece : pieces) {
    const double angle = std::min(left, piece.length);
    if (!(angle > 0.0)) continue;
    left -= angle;
    const double side = piece.turn;
    pose = pose * (side == 0.0
                       ? Transform2<Base, Base>(angle * radius_m, 0.0, 0.0)
                       : Transform2<Base, Base>(radius_m * std::sin(angle),
                                                side * radius_m * (1.0 - std::cos(angle)), side * angle));
  }
  return pose;
}

}  // namespace madori::planning
