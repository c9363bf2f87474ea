#include "control/braking/measured_stop.hpp"

#include <algorithm>
#include <cmath>

namespace madori::control {
namespace {

constexpr double kBeforeS = 0.3;  ///< the speed is taken over so long before the word
constexpr double kStandsMps = 0.005;
constexpr double kWindowS = 0.04;  ///< of one speed: an encoder's step is a small part of the way in it

double way_at(const std::vector<Rolled>& track, Stamp moment) {
  const auto after = std::lower_bound(track.begin(), track.end(), moment,
                                      [](const Rolled& r, Stamp at) { return r.stamp < at; });
  if (after == track.begin()) return track.front().way_m;
  if (after == track.end()) return track.back().way_m;
  const auto before = after - 1;
  const double share = to_seconds(moment - before->stamp) / to_seconds(after->stamp - before->stamp);
  return before->way_m + share * (after->way_m - before->way_m);
}

double speed_at(const std::vector<Rolled>& track, Stamp moment) {
  const Duration half = duration_from_seconds(kWindowS / 2.0);
  return (way_at(track, moment + half) - way_at(track, moment - half)) / kWindowS;
}

/// Slope of speed over time by least squares, between two shares of the speed; 0 where it cannot be told.
double slope(const std::vector<Rolled>& track, Stamp told, double speed_mps) {
  constexpr double kFrom = 0.8, kTo = 0.2;
  double n = 0.0, t_sum = 0.0, v_sum = 0.0, tt = 0.0, tv = 0.0;
  for (const Rolled& r : track) {
    if (r.stamp <= told) continue;
    const double v = speed_at(track, r.stamp);
    if (v > kFrom * speed_mps) continue;
    if (v < kTo * speed_mps) break;
    const double t = to_seconds(r.stamp - told);
    n += 1.0, t_sum += t, v_sum += v, tt += t * t, tv += t * v;
  }
  const double spread = n * tt - t_sum * t_sum;
  return n >= 3.0 && spread > 0.0 ? (n * tv - t_sum * v_sum) / spread : 0.0;
}

}  // namespace

bool has_stopped(const std::vector<Rolled>& track, double still_s) {
  if (track.empty()) return false;
  const Stamp from = track.back().stamp - duration_from_seconds(still_s);
  return track.front().stamp <= from &&
         std::abs(track.back().way_m - way_at(track, from)) < kStandsMps * still_s;
}

std::optional<MeasuredStop> measure_stop(const std::vector<Rolled>& track, Stamp told) {
  const Stamp from = told - duration_from_seconds(kBeforeS);
  if (track.empty() || track.front().stamp > from || !has_stopped(track, kBeforeS)) return std::nullopt;
  MeasuredStop stop;
  stop.speed_mps = (way_at(track, told) - way_at(track, from)) / kBeforeS;
  if (!(stop.speed_mps > 10.0 * kStandsMps)) return std::nullopt;
  stop.deceleration_mps2 = -slope(track, told, stop.speed_mps);
  if (!(stop.deceleration_mps2 > 0.0)) return std::nullopt;
  stop.way_m = track.back().way_m - way_at(track, told);
  const double braking_m = stop.speed_mps * stop.speed_mps / (2.0 * stop.deceleration_mps2);
  stop.latency_s = std::max(0.0, (stop.way_m - braking_m) / stop.speed_mps);
  return stop;
}

}  // namespace madori::control
