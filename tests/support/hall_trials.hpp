#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "localization/global/global_localizer.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::test {

/// Absolute localization as in tables 1 and 2 of Kis et al. (2021): random poses, one scan each.
struct TrialSettings {
  int poses = 200;
  double sigma_m = 0.0;  ///< on x and y of each point, as the paper adds it
  double clutter = 0.0;
  ScanSettings scan;  ///< 270 degrees in steps of half a degree unless set otherwise
  double clearance_m = 0.5;
  double least_view_m = 4.0;
  double within_m = 0.2;  ///< what counts as right
  double within_rad = to_rad(2.0);
};

struct TrialResult {
  int right = 0;       ///< the likeliest place is the true one, whatever the state
  int found = 0;       ///< and the answer was sure of it
  int wrong_sure = 0;  ///< the answer was sure of another place
  int ambiguous = 0;
  int nowhere = 0;
  double e_psr_mean_m = 0.0;  ///< of the right ones
  double e_psr_std_m = 0.0;
};

/// `timed(locate)` runs each search; so that a bench may measure it.
template <class Timed>
TrialResult run_trials(const mapping::Walls& walls, const localization::GlobalLocalizer& global,
                       const TrialSettings& settings, unsigned seed, Timed&& timed) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> noise(0.0F, 1.0F);
  TrialResult result;
  std::vector<double> e_psr;
  for (int i = 0; i < settings.poses; ++i) {
    const Transform2<Map, Base> truth =
        random_pose(walls, global.distance_field(), settings.clearance_m, settings.least_view_m, engine);
    ScanSettings scan = settings.scan;
    scan.clutter = settings.clutter;
    localization::ScanPoints points =
        localization::scan_points(simulate_scan(walls, truth, scan, engine), {});
    for (auto* array : {&points.x_m, &points.y_m})
      for (float& v : *array) v += static_cast<float>(settings.sigma_m) * noise(engine);
    localization::GlobalAnswer answer;
    timed([&] { answer = global.locate(points); });
    bool right = false;
    if (!answer.hypotheses.empty()) {
      const auto& fit = answer.hypotheses.front().fit;
      right = distance_m(fit.map_from_base.translation(), truth.translation()) < settings.within_m &&
              std::abs(wrap_angle(fit.map_from_base.yaw_rad() - truth.yaw_rad())) < settings.within_rad;
      if (right) e_psr.push_back(fit.e_psr_m);
    }
    const bool sure = answer.state == localization::GlobalState::Found;
    result.right += right;
    result.found += sure && right;
    result.wrong_sure += sure && !right;
    result.ambiguous += answer.state == localization::GlobalState::Ambiguous;
    result.nowhere += answer.state == localization::GlobalState::Nowhere;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(e_psr.size(), 1));
  for (const double e : e_psr) result.e_psr_mean_m += e / n;
  for (const double e : e_psr)
    result.e_psr_std_m += (e - result.e_psr_mean_m) * (e - result.e_psr_mean_m) / n;
  result.e_psr_std_m = std::sqrt(result.e_psr_std_m);
  return result;
}

}  // namespace madori::test
