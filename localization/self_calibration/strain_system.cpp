#include "localization/self_calibration/strain_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "localization/pose_axes.hpp"
#include "localization/self_calibration/strain_search.hpp"

namespace madori::localization {
namespace {

constexpr double kStrainPrior = 0.05;
constexpr double kPosePriorM = 2.0;  // only against directions that a keyframe does not see
constexpr double kPosePriorRad = 0.3;
constexpr double kMotionLoss = 3.0;  // sigmas

using Triplets = std::vector<Eigen::Triplet<double>>;

/// A motion between two keyframes: error, and its slopes in both poses (x, y, yaw, Map axes).
struct MotionRow {
  Eigen::Vector3d error;
  Eigen::Matrix3d by_from;
  Eigen::Matrix3d by_to;
};

MotionRow motion_row(const RelativeFactor& f, const Transform2<Map, Base>& from,
                     const Transform2<Map, Base>& to) {
  const double c = from.cos_yaw();
  const double s = from.sin_yaw();
  const double dx = to.x_m() - from.x_m();
  const double dy = to.y_m() - from.y_m();
  MotionRow row;
  row.error = {c * dx + s * dy - f.motion.x_m(), -s * dx + c * dy - f.motion.y_m(),
               wrap_angle(to.yaw_rad() - from.yaw_rad() - f.motion.yaw_rad())};
  row.by_from << -c, -s, -s * dx + c * dy, s, -c, -c * dx - s * dy, 0.0, 0.0, -1.0;
  row.by_to << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  return row;
}

void add_block(Triplets& triplets, int row, int column, const Eigen::Matrix3d& block) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) triplets.emplace_back(row + i, column + j, block(i, j));
}

/// Normal equations: poses (sparse), what couples them to the rest, and the rest: strain and wall offsets.
struct Equations {
  Equations(int pose_unknowns, int others)
      : coupling(Eigen::MatrixXd::Zero(pose_unknowns, others)),
        rest(Eigen::MatrixXd::Zero(others, others)),
        pose_side(Eigen::VectorXd::Zero(pose_unknowns)),
        rest_side(Eigen::VectorXd::Zero(others)) {}

  void add(const StrainRow& row) {
    const int at = 3 * row.keyframe;
    const int wall = 3 + row.wall;
    add_block(poses, at, at, row.weight * row.by_pose * row.by_pose.transpose());
    coupling.block<3, 3>(at, 0) += row.weight * row.by_pose * row.by_strain.transpose();
    coupling.block<3, 1>(at, wall) -= row.weight * row.by_pose;
    rest.topLeftCorner<3, 3>() += row.weight * row.by_strain * row.by_strain.transpose();
    rest.block<3, 1>(0, wall) -= row.weight * row.by_strain;
    rest.block<1, 3>(wall, 0) -= row.weight * row.by_strain.transpose();
    rest(wall, wall) += row.weight;
    pose_side.segment<3>(at) -= row.weight * row.residual_m * row.by_pose;
    rest_side.head<3>() -= row.weight * row.residual_m * row.by_strain;
    rest_side[wall] += row.weight * row.residual_m;
  }

  void add(const RelativeFactor& f, const Transform2<Map, Base>& from, const Transform2<Map, Base>& to) {
    const MotionRow row = motion_row(f, from, to);
    const double z = std::sqrt(std::max(0.0, row.error.dot(f.information * row.error)));
    const Eigen::Matrix3d information = f.information * geman_mcclure(z, kMotionLoss);
    const Eigen::Matrix3d a = row.by_from.transpose() * information;
    const Eigen::Matrix3d b = row.by_to.transpose() * information;
    const int i = 3 * f.from;
    const int j = 3 * f.to;
    add_block(poses, i, i, a * row.by_from);
    add_block(poses, j, j, b * row.by_to);
    add_block(poses, i, j, a * row.by_to);
    add_block(poses, j, i, b * row.by_from);
    pose_side.segment<3>(i) -= a * row.error;
    pose_side.segment<3>(j) -= b * row.error;
  }

  /// Against directions that a keyframe does not see; `off` from where the localizer had it.
  void add_pose_prior(int keyframe, const Eigen::Vector3d& off) {
    const double m = 1.0 / (kPosePriorM * kPosePriorM);
    const Eigen::Vector3d information(m, m, 1.0 / (kPosePriorRad * kPosePriorRad));
    const int at = 3 * keyframe;
    add_block(poses, at, at, information.asDiagonal());
    pose_side.segment<3>(at) -= information.cwiseProduct(off);
  }

  Triplets poses;
  Eigen::MatrixXd coupling;
  Eigen::MatrixXd rest;
  Eigen::VectorXd pose_side;
  Eigen::VectorXd rest_side;
};

/// The step of all unknowns; `good` is false where the equations cannot be solved.
struct Step {
  bool good = false;
  Eigen::VectorXd poses;
  Eigen::VectorXd rest;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
};

Step step_of(const Equations& eq) {
  Step step;
  Eigen::SparseMatrix<double> poses(eq.pose_side.size(), eq.pose_side.size());
  poses.setFromTriplets(eq.poses.begin(), eq.poses.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> pose_factor(poses);
  if (pose_factor.info() != Eigen::Success) return step;
  const Eigen::MatrixXd eliminated = pose_factor.solve(eq.coupling);
  const Eigen::LDLT<Eigen::MatrixXd> rest_factor(eq.rest - eq.coupling.transpose() * eliminated);
  if (rest_factor.info() != Eigen::Success) return step;
  step.rest = rest_factor.solve(eq.rest_side - eliminated.transpose() * eq.pose_side);
  step.poses = pose_factor.solve(eq.pose_side - eq.coupling * step.rest);
  step.covariance = rest_factor.solve(Eigen::MatrixXd::Identity(step.rest.size(), 3)).topRows<3>();
  step.good = step.rest.allFinite() && step.poses.allFinite() && step.covariance.allFinite();
  return step;
}

}  // namespace

StrainSystem::StrainSystem(const WallIndex& drawing, const std::vector<CalibrationKeyframe>& keyframes,
                           const std::vector<RelativeFactor>& motions, const CalibrationOptions& options,
                           const Eigen::Vector3d& start)
    : drawing_(drawing),
      keyframes_(keyframes),
      motions_(motions),
      options_(options),
      strained_{middle_of(keyframes), start},
      position_(drawing.walls().size(), -1) {
  for (const CalibrationKeyframe& k : keyframes)
    poses_.push_back(
        fit_keyframe(drawing, strained_, unstrained(k.map_from_base, strained_), k.pieces, options));
  first_poses_ = poses_;
}

double StrainSystem::explained_m(double scale_m) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < keyframes_.size(); ++k)
    sum += localization::explained_m(drawing_, strained_, poses_[k], keyframes_[k].pieces, scale_m,
                                     options_.beside_m);
  return sum;
}

int StrainSystem::seen_wall(int wall) {
  int& position = position_[static_cast<std::size_t>(wall)];
  if (position < 0) {
    position = static_cast<int>(offsets_.size());
    offsets_.push_back(0.0);
  }
  return position;
}

std::vector<StrainRow> StrainSystem::associate(double scale_m) {
  std::vector<StrainRow> rows;
  for (std::size_t k = 0; k < keyframes_.size(); ++k)
    for (const SurfacePiece& piece : keyframes_[k].pieces)
      if (auto row = row_of(poses_[k], piece)) {
        row->keyframe = static_cast<int>(k);
        row->weight = piece.length_m / (options_.piece_sigma_m * options_.piece_sigma_m) *
                      geman_mcclure(row->residual_m, scale_m);
        rows.push_back(*row);
      }
  return rows;
}

std::optional<StrainRow> StrainSystem::row_of(const Transform2<Map, Base>& pose, const SurfacePiece& piece) {
  auto row = strain_row(drawing_, strained_, pose, piece, options_.beside_m);
  if (!row) return row;
  row->wall = seen_wall(row->wall);
  row->residual_m -= offsets_[static_cast<std::size_t>(row->wall)];
  return row;
}

void StrainSystem::take(const Eigen::VectorXd& pose_step, const Eigen::VectorXd& rest_step) {
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    poses_[k] = {poses_[k].x_m() + pose_step[at], poses_[k].y_m() + pose_step[at + 1],
                 poses_[k].yaw_rad() + pose_step[at + 2]};
  }
  strained_.strain += rest_step.head<3>();
  for (std::size_t w = 0; w < offsets_.size(); ++w)
    offsets_[w] += rest_step[static_cast<Eigen::Index>(3 + w)];
}

StrainSolution StrainSystem::solve(double scale_m, double wall_sigma_m) {
  const std::vector<StrainRow> rows = associate(scale_m);
  StrainSolution solution;
  if (rows.empty()) return solution;
  Equations eq(3 * static_cast<int>(poses_.size()), 3 + static_cast<int>(offsets_.size()));
  double chi2 = 0.0;
  double freedom = -3.0;
  for (const StrainRow& row : rows) {
    eq.add(row);
    chi2 += row.weight * row.residual_m * row.residual_m;
    freedom += row.weight * options_.piece_sigma_m * options_.piece_sigma_m;
  }
  for (const RelativeFactor& f : motions_)
    eq.add(f, poses_[static_cast<std::size_t>(f.from)], poses_[static_cast<std::size_t>(f.to)]);
  for (std::size_t k = 0; k < poses_.size(); ++k)
    eq.add_pose_prior(static_cast<int>(k), pose_difference(poses_[k], first_poses_[k]));
  eq.rest.topLeftCorner<3, 3>().diagonal().array() += 1.0 / (kStrainPrior * kStrainPrior);
  eq.rest_side.head<3>() -= strained_.strain / (kStrainPrior * kStrainPrior);
  for (std::size_t w = 0; w < offsets_.size(); ++w) {
    const auto at = static_cast<Eigen::Index>(3 + w);
    const double weight =
        geman_mcclure(offsets_[w], kWallLossSigmas * wall_sigma_m) / (wall_sigma_m * wall_sigma_m);
    eq.rest(at, at) += weight;
    eq.rest_side[at] -= weight * offsets_[w];
  }
  const Step step = step_of(eq);
  if (!step.good) return solution;
  take(step.poses, step.rest);
  return {true,
          step.rest.head<3>(),
          step.covariance,
          offsets_,
          freedom > 1.0 ? chi2 / freedom : 1.0,
          static_cast<int>(rows.size())};
}

}  // namespace madori::localization
