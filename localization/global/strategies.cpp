#include "localization/global/strategies.hpp"

#include <cmath>

#include "localization/registration/cpd.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Among the assumed position and six around it, and turns within 45 degrees, the pose that RDNM likes best.
Pose locally_likeliest(const ScanPoints& scan, const PointMap& map, const Pose& assumed,
                       const StrategyOptions& options) {
  std::vector<Point2<Map>> around;
  for (const Point2<Map>& p : map.points())
    if (distance_m(p, assumed.translation()) < options.view_radius_m) around.push_back(p);
  std::vector<Point2<Map>> candidates{assumed.translation()};
  for (int i = 0; i < 6; ++i) {
    const double angle = i * kPi / 3.0;
    candidates.push_back({assumed.x_m() + options.candidate_radius_m * std::cos(angle),
                          assumed.y_m() + options.candidate_radius_m * std::sin(angle)});
  }
  const auto found = rdnm(scan, around, candidates, options.rdn);
  if (!found) return assumed;
  const bool turned_away =
      std::abs(wrap_angle(found->map_from_base.yaw_rad() - assumed.yaw_rad())) > kPi / 4.0;
  return turned_away ? assumed : found->map_from_base;
}

}  // namespace

const char* to_string(Strategy strategy) {
  switch (strategy) {
    case Strategy::Rdnm:
      return "RDNM";
    case Strategy::Cpd:
      return "CPD";
    case Strategy::Absolute:
      return "absolute";
  }
  return "";
}

std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan, const GlobalLocalizer& global,
                                                  const StrategyOptions& options) {
  const GlobalAnswer answer = global.locate(scan);
  if (answer.hypotheses.empty()) return std::nullopt;
  const RegistrationResult& fit = answer.hypotheses.front().fit;
  if (!(fit.e_psr_m < options.most_e_psr_m)) return std::nullopt;
  return StrategyResult{fit, Strategy::Absolute};
}

std::optional<StrategyResult> localize_relatively(const ScanPoints& scan, const GlobalLocalizer& global,
                                                  const PointMap& map, const Pose& assumed,
                                                  const StrategyOptions& options) {
  const RegistrationResult near =
      segment_icp(scan, global.grid(), locally_likeliest(scan, map, assumed, options));
  if (near.converged && near.e_psr_m < options.most_e_psr_m) return StrategyResult{near, Strategy::Rdnm};
  const RegistrationResult rough = cpd(scan, map, assumed);
  const RegistrationResult drifted = segment_icp(scan, global.grid(), rough.map_from_base);
  if (drifted.converged && drifted.e_psr_m < options.most_e_psr_m)
    return StrategyResult{drifted, Strategy::Cpd};
  return localize_absolutely(scan, global, options);
}

}  // namespace madori::localization
