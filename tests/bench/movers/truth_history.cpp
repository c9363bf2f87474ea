#include "tests/bench/movers/truth_history.hpp"

#include <algorithm>
#include <cmath>

#include "tests/bench/movers/mover_match.hpp"

namespace madori::bench {
namespace {

constexpr double kKeptS = 2.0;       ///< the longest look back, and the way of a scan to the cycle
constexpr double kLatelyS = 0.5;     ///< who has to be found has moved so long ...
constexpr double kSlowestMps = 0.2;  ///< ... so fast: below, a person shifts from foot to foot
constexpr double kStillS = 1.0;      ///< who tells that somebody moves is right so long after he stopped
constexpr double kStillM = 0.02;     ///< within which he stands

}  // namespace

void TruthHistory::note() {
  moments_.push_back({factory_.now(), factory_.truth().building_from_base, factory_.bodies()});
  while (to_seconds(moments_.back().stamp - moments_.front().stamp) > kKeptS) moments_.pop_front();
}

std::optional<std::size_t> TruthHistory::moment_after(Stamp stamp) const {
  const auto after = std::lower_bound(moments_.begin(), moments_.end(), stamp,
                                      [](const Moment& m, Stamp at) { return m.stamp < at; });
  if (after == moments_.begin() || after == moments_.end()) return std::nullopt;
  return static_cast<std::size_t>(after - moments_.begin());
}

const simulation::Body* TruthHistory::find(const Moment& moment, const std::string& name) {
  const auto at = std::find_if(moment.bodies.begin(), moment.bodies.end(),
                               [&](const simulation::Body& b) { return b.name == name; });
  return at == moment.bodies.end() ? nullptr : &*at;
}

bool TruthHistory::is_leaf(const simulation::Body& body) const {
  return std::any_of(factory_.doors().begin(), factory_.doors().end(),
                     [&](const auto& door) { return door.name() == body.name; });
}

double TruthHistory::moved_m(const simulation::Body& body, Stamp stamp) const {
  double most_m = 0.0;
  for (const Moment& moment : moments_)
    if (moment.stamp >= stamp)
      if (const auto* then = find(moment, body.name))
        most_m = std::max(most_m, distance_m(then->centre, body.centre));
  return most_m;
}

std::optional<Transform2<Building, Base>> TruthHistory::vehicle_at(Stamp stamp) const {
  const auto after = moment_after(stamp);
  if (!after) return std::nullopt;
  const Moment &a = moments_[*after - 1], &b = moments_[*after];
  const double share = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  const auto step = a.vehicle.inverse() * b.vehicle;
  return a.vehicle * Transform2<Base, Base>(share * step.x_m(), share * step.y_m(), share * step.yaw_rad());
}

std::vector<TrueMover> TruthHistory::movers_at(Stamp stamp, const LidarPlace& lidar) const {
  std::vector<TrueMover> movers;
  const auto after = moment_after(stamp);
  if (!after) return movers;
  const Moment &a = moments_[*after - 1], &b = moments_[*after];
  const double step_s = to_seconds(b.stamp - a.stamp);
  const double share = to_seconds(stamp - a.stamp) / step_s;
  for (const simulation::Body& end : b.bodies) {
    const simulation::Body* begin = find(a, end.name);
    if (begin == nullptr) continue;
    TrueMover mover{end.name, end.round ? Traffic::Person : Traffic::Truck, end};
    const double dx_m = end.centre.x_m - begin->centre.x_m, dy_m = end.centre.y_m - begin->centre.y_m;
    mover.body.centre = {begin->centre.x_m + share * dx_m, begin->centre.y_m + share * dy_m};
    mover.vx_mps = dx_m / step_s;
    mover.vy_mps = dy_m / step_s;
    mover.range_m = distance_to(mover.body, lidar.pose.translation());
    if (!is_leaf(end)) judge(mover, stamp, a.bodies, lidar);
    movers.push_back(std::move(mover));
  }
  return movers;
}

void TruthHistory::judge(TrueMover& mover, Stamp stamp, const std::vector<simulation::Body>& all,
                         const LidarPlace& lidar) const {
  mover.moves = moved_m(mover.body, stamp - duration_from_seconds(kStillS)) > kStillM;
  mover.asked = std::hypot(mover.vx_mps, mover.vy_mps) > kSlowestMps &&
                moved_m(mover.body, stamp - duration_from_seconds(kLatelyS)) > kLatelyS * kSlowestMps &&
                is_in_plain_sight(beams_on(mover.body, all, factory_.world().rays(), lidar));
}

}  // namespace madori::bench
