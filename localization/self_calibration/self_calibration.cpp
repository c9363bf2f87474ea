#include "localization/self_calibration/self_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/median.hpp"
#include "localization/self_calibration/strain_search.hpp"
#include "localization/self_calibration/strain_system.hpp"

namespace madori::localization {
namespace {

constexpr double kSmallestStep = 1e-7;  // of the strain, converged below
constexpr double kShareOfSigma = 0.1;   // likewise: what is smaller is lost in the uncertainty

/// Median absolute value as a standard deviation.
double robust_sigma(std::vector<double> values) {
  if (values.empty()) return 0.0;
  for (double& v : values) v = std::abs(v);
  return 1.4826 * median_of(values);
}

Eigen::Vector3d uniform_direction() {
  return {1.0, 1.0, 0.0};
}

/// One descent, and the metres of surface that its stretched drawing explains.
struct Descent {
  SelfCalibration found;
  double explained_m = 0.0;
};

/// Walls that stand clearly beside where they are drawn: seen as long as the loss is wide.
int displaced_walls(StrainSystem system, double wall_sigma_m, const CalibrationOptions& options) {
  constexpr int kRounds = 3;
  constexpr double kClearlyM = 0.15;
  StrainSolution wide;
  for (int round = 0; round < kRounds; ++round)
    wide = system.solve(options.first_scale_m, options.wall_most_m);
  return static_cast<int>(std::count_if(
      wide.wall_offsets_m.begin(), wide.wall_offsets_m.end(),
      [&](double d) { return std::abs(d) > std::max(kClearlyM, kWallLossSigmas * wall_sigma_m); }));
}

Descent descend(StrainSystem system, const CalibrationOptions& options) {
  Descent descent;
  SelfCalibration& result = descent.found;
  double scale = options.joint_scale_m;
  double wall_sigma = options.wall_first_m;
  StrainSolution solution;
  for (int round = 0; round < options.rounds; ++round) {
    solution = system.solve(scale, wall_sigma);
    if (!solution.good) return descent;
    scale = std::max(options.last_scale_m, 0.7 * scale);
    wall_sigma = std::clamp(robust_sigma(solution.wall_offsets_m), options.wall_least_m, options.wall_most_m);
  }
  result.converged =
      solution.step.cwiseAbs().maxCoeff() <
      std::max(kSmallestStep, kShareOfSigma * std::sqrt(solution.covariance.diagonal().minCoeff()));
  result.strain = system.strain();
  result.covariance = solution.covariance * std::max(1.0, solution.chi2_per_freedom);
  result.wall_sigma_m = wall_sigma;
  result.walls = static_cast<int>(solution.wall_offsets_m.size());
  result.displaced = displaced_walls(system, wall_sigma, options);
  result.pieces = solution.pieces;
  descent.explained_m = system.explained_m(options.last_scale_m);
  return descent;
}

/// Does another strain explain about as much?
bool has_rival(const Descent& best, const std::vector<Descent>& all, const CalibrationOptions& options) {
  return std::any_of(all.begin(), all.end(), [&](const Descent& d) {
    return d.explained_m > options.rival_share * best.explained_m &&
           (d.found.strain - best.found.strain).cwiseAbs().maxCoeff() > options.other_strain;
  });
}

}  // namespace

double SelfCalibration::uniform() const {
  const Eigen::Matrix3d information = covariance.llt().solve(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d one = uniform_direction();
  return one.dot(information * strain) / one.dot(information * one);
}

double SelfCalibration::uniform_sigma() const {
  const Eigen::Vector3d one = uniform_direction();
  return 1.0 / std::sqrt(one.dot(covariance.llt().solve(one)));
}

double SelfCalibration::stretch_chi2() const {
  const Eigen::Vector3d rest = strain - uniform() * uniform_direction();
  return rest.dot(covariance.llt().solve(rest));
}

SelfCalibration self_calibrate(const WallIndex& drawing, const std::vector<CalibrationKeyframe>& keyframes,
                               const std::vector<RelativeFactor>& motions,
                               const CalibrationOptions& options) {
  std::vector<Descent> tried;
  for (const StrainPeak& peak : search_strains(drawing, keyframes, options))
    if (static_cast<int>(tried.size()) < options.most_starts)
      tried.push_back(descend({drawing, keyframes, motions, options, peak.strain}, options));
  Descent best;
  for (const Descent& d : tried)
    if (d.explained_m > best.explained_m) best = d;
  best.found.converged = best.found.converged && !has_rival(best, tried, options);
  best.found.keyframes = static_cast<int>(keyframes.size());
  return best.found;
}

}  // namespace madori::localization
