#include "tests/bench/buildings/clearances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/beam_to_segment.hpp"

namespace madori::bench {
namespace {

constexpr double kHoldsM = 0.15;   ///< of issue 14
constexpr double kNearM = 4.0;     ///< walls around a station
constexpr double kFartherM = 2.0;  ///< then it is another wall
constexpr double kEdgeM = 0.5;     ///< beams 3 degrees apart that differ by more look past an edge
constexpr double kUnknown = -1.0;

template <class Frame>
double cast(const std::vector<Segment2<Frame>>& walls, const Point2<Frame>& from, double direction_rad) {
  const double dx = std::cos(direction_rad), dy = std::sin(direction_rad);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& wall : walls) nearest_m = std::min(nearest_m, beam_meets_m(wall, from, dx, dy));
  return nearest_m;
}

}  // namespace

template <class Frame>
Clearances clearances(const std::vector<Segment2<Frame>>& walls, const Point2<Frame>& at, double turn_rad) {
  constexpr double kBesideRad = to_rad(3.0);
  Clearances result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double direction = turn_rad + static_cast<double>(i) * kPi / 4.0;
    std::array<double, 3> beams{cast(walls, at, direction - kBesideRad), cast(walls, at, direction),
                                cast(walls, at, direction + kBesideRad)};
    const double ahead_m = beams[1];
    const auto [least, most] = std::minmax_element(beams.begin(), beams.end());
    const bool one_wall = std::isfinite(*most) && *most - *least <= kEdgeM;
    result[i] = one_wall ? ahead_m : kUnknown;
  }
  return result;
}

template Clearances clearances(const std::vector<Segment2<Map>>&, const Point2<Map>&, double);
template Clearances clearances(const std::vector<Segment2<simulation::Building>>&,
                               const Point2<simulation::Building>&, double);

StationFit compare(const Clearances& drawn, const Clearances& in_truth) {
  StationFit fit;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double d = drawn[i], t = in_truth[i];
    if (d < 0.0 || t < 0.0 || d > kNearM || t > d + kFartherM) continue;
    ++fit.compared;
    double off_m = std::abs(t - d);
    const std::size_t opposite = (i + drawn.size() / 2) % drawn.size();
    const double across = drawn[opposite], true_across = in_truth[opposite];
    if (across >= 0.0 && true_across >= 0.0)
      off_m = std::min(off_m, std::abs(t - (t + true_across) * d / (d + across)));
    fit.held += off_m <= kHoldsM ? 1 : 0;
    fit.worst_m = std::max(fit.worst_m, off_m);
  }
  return fit;
}

bool can_hold(const Clearances& drawn, const std::vector<Segment2<simulation::Building>>& walls,
              const Point2<simulation::Building>& near, double turn_rad) {
  constexpr double kReachM = 1.0, kStepM = 0.05;
  for (double x = -kReachM; x <= kReachM; x += kStepM)
    for (double y = -kReachM; y <= kReachM; y += kStepM) {
      const Point2<simulation::Building> at{near.x_m + x, near.y_m + y};
      const auto fit = compare(drawn, clearances(walls, at, turn_rad));
      if (fit.compared > 1 && fit.good()) return true;
    }
  return false;
}

}  // namespace madori::bench
