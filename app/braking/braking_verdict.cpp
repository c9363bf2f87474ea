#include "app/braking/braking_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "app/braking/braking_test.hpp"
#include "core/fill_in.hpp"
#include "core/result.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::app {
namespace {

constexpr double kCyclePeriodS = 0.02;
constexpr double kPerHundredth = 100.0;
constexpr double kRounding = 1e-6;

double rounded_down(double value) {
  return std::floor(value * kPerHundredth + kRounding) / kPerHundredth;
}
double rounded_up(double value) {
  return std::ceil(value * kPerHundredth - kRounding) / kPerHundredth;
}

}  // namespace

BrakingSite braking_site(const CycleConfig& config) {
  return {config.limits.max_speed_mps,
          config.sure_range_m,
          config.check.braking.scan_period_s,
          braking_test_way_m(config.limits.max_speed_mps, config),
          config.check.braking.deceleration_mps2,
          config.check.braking.reaction_s};
}

std::optional<BrakingVerdict> verdict_of(const std::vector<BrakingStop>& stops, const BrakingSite& site) {
  if (stops.empty()) return std::nullopt;
  double weakest = stops.front().stop.deceleration_mps2, slowest = 0.0;
  for (const auto& [loaded, stop] : stops) {
    weakest = std::min(weakest, stop.deceleration_mps2);
    slowest = std::max(slowest, stop.latency_s);
  }
  BrakingVerdict verdict;
  verdict.deceleration_mps2 = rounded_down(weakest);
  verdict.reaction_s = rounded_up(slowest + kCyclePeriodS);
  if (std::ranges::none_of(stops, &BrakingStop::loaded)) {  // with a load they can only be worse
    verdict.deceleration_mps2 = std::min(verdict.deceleration_mps2, site.deceleration_mps2);
    verdict.reaction_s = std::max(verdict.reaction_s, site.reaction_s);
  }
  planning::BrakingModel braking;
  braking.deceleration_mps2 = verdict.deceleration_mps2;
  braking.reaction_s = verdict.reaction_s;
  braking.scan_period_s = site.scan_period_s;
  verdict.needs_m = braking.horizon_m(site.top_speed_mps);
  verdict.sees_m = site.sees_m;
  verdict.allowed_mps = rounded_down(braking.speed_within(site.sees_m));
  return verdict;
}

mapping::VehicleRecord with_measured(mapping::VehicleRecord record, const BrakingVerdict& verdict,
                                     bool lower_speed) {
  if (outruns(verdict, record.max_speed_mps) && !lower_speed)
    throw Error("site.yaml",
                "at " + two_decimals(record.max_speed_mps) + " m/s the vehicle needs " +
                    two_decimals(verdict.needs_m) + " m to stand, and the lidar is sure to see " +
                    two_decimals(verdict.sees_m) + " m",
                "lower max_speed_mps to " + two_decimals(verdict.allowed_mps) +
                    ", or mount a lidar with a finer step");
  record.max_deceleration_mps2 = verdict.deceleration_mps2;
  record.reaction_s = verdict.reaction_s;
  if (outruns(verdict, record.max_speed_mps)) record.max_speed_mps = verdict.allowed_mps;
  return record;
}

}  // namespace madori::app
