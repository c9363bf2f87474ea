#include "localization/self_calibration/self_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/self_calibration/strain_system.hpp"

namespace madori::localization {
namespace {

constexpr double kSmallestStep = 1e-7;  // of the strain, converged below
constexpr double kShareOfSigma = 0.1;   // likewise: what is smaller is lost in the uncertainty

/// Median absolute value as a standard deviation.
double robust_sigma(std::vector<double> values) {
  if (values.empty()) return 0.0;
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return 1.4826 * *middle;
}

Eigen::Vector3d uniform_direction() {
  return {1.0, 1.0, 0.0};
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

namespace {

/// One descent, and the metres of surface that its stretched drawing explains.
struct Descent {
  SelfCalibration found;
  double explained_m = 0.0;
};

Descent descend(StrainSystem system, const CalibrationOptions& options) {
  Descent descent;
  SelfCalibration& result = descent.found;
  double scale = options.first_scale_m;
  double wall_sigma = options.wall_prior_m;
  StrainSolution solution;
  for (int round = 0; round < options.rounds; ++round) {
    solution = system.solve(scale, wall_sigma);
    if (!solution.good) return descent;
    scale = std::max(options.last_scale_m, 0.7 * scale);
    wall_sigma =
        std::clamp(robust_sigma(solution.wall_offsets_m), options.wall_least_m, options.wall_prior_m);
  }
  result.converged =
      solution.step.cwiseAbs().maxCoeff() <
      std::max(kSmallestStep, kShareOfSigma * std::sqrt(solution.covariance.diagonal().minCoeff()));
  result.strain = system.strain();
  result.covariance = solution.covariance * std::max(1.0, solution.chi2_per_freedom);
  result.wall_sigma_m = wall_sigma;
  result.walls = static_cast<int>(solution.wall_offsets_m.size());
  result.displaced = static_cast<int>(
      std::count_if(solution.wall_offsets_m.begin(), solution.wall_offsets_m.end(),
                    [&](double d) { return std::abs(d) > std::max(0.15, kWallLossSigmas * wall_sigma); }));
  result.pieces = solution.pieces;
  descent.explained_m = system.explained_m(options.last_scale_m);
  return descent;
}

}  // namespace

SelfCalibration self_calibrate(const WallIndex& drawing, const std::vector<CalibrationKeyframe>& keyframes,
                               const std::vector<RelativeFactor>& motions,
                               const CalibrationOptions& options) {
  Descent best;
  for (const double start : options.starts) {
    const Descent descent = descend({drawing, keyframes, motions, options, start}, options);
    if (descent.explained_m > best.explained_m) best = descent;
  }
  best.found.keyframes = static_cast<int>(keyframes.size());
  return best.found;
}

}  // namespace madori::localization
