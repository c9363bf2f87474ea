#include "localization/memory/pose_graph.hpp"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

/// A with A'A = m, for a symmetric positive semi-definite m.
Eigen::Matrix3d square_root(const Eigen::Matrix3d& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (m + m.transpose()));
  const Eigen::Vector3d roots = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return roots.asDiagonal() * solver.eigenvectors().transpose();
}

/// e = (R_i' (t_j - t_i) - t_z, yaw_j - yaw_i - yaw_z), whitened.
class RelativeCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit RelativeCost(const RelativeFactor& factor)
      : motion_(factor.motion), root_(square_root(factor.information)) {}

  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const double c = std::cos(p[0][2]);
    const double s = std::sin(p[0][2]);
    const double dx = p[1][0] - p[0][0];
    const double dy = p[1][1] - p[0][1];
    const Eigen::Vector3d e(c * dx + s * dy - motion_.x_m(), -s * dx + c * dy - motion_.y_m(),
                            wrap_angle(p[1][2] - p[0][2] - motion_.yaw_rad()));
    Eigen::Map<Eigen::Vector3d>{residuals} = root_ * e;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>{jacobians[0]} = root_ * relative_jacobians(p[0][2], dx, dy).by_from;
    }
    if (jacobians != nullptr && jacobians[1] != nullptr) {
      Eigen::Map<RowMajor>{jacobians[1]} = root_ * relative_jacobians(p[0][2], dx, dy).by_to;
    }
    return true;
  }

 private:
  Transform2<Base, Base> motion_;
  Eigen::Matrix3d root_;
};

/// The quadratic as a least-squares residual: A d + A^-T g, with A'A = H, in the directions that H sees.
class UnaryCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  explicit UnaryCost(const UnaryFactor& factor) : at_(factor.at) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
        0.5 * (factor.hessian + factor.hessian.transpose()));
    const double largest = solver.eigenvalues()[2];
    for (int i = 0; i < 3; ++i) {
      const double value = solver.eigenvalues()[i];
      if (value > 1e-9 * largest && value > 0.0) {
        root_.row(i) = std::sqrt(value) * solver.eigenvectors().col(i).transpose();
        offset_[i] = solver.eigenvectors().col(i).dot(factor.gradient) / std::sqrt(value);
      }
    }
  }

  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const Eigen::Vector3d d(p[0][0] - at_.x_m(), p[0][1] - at_.y_m(), wrap_angle(p[0][2] - at_.yaw_rad()));
    Eigen::Map<Eigen::Vector3d>{residuals} = root_ * d + offset_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[0]} = root_;
    }
    return true;
  }

 private:
  Transform2<Map, Base> at_;
  Eigen::Matrix3d root_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
};

ceres::Solver::Options solver_options(const GraphOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = 1;  // the same answer on every machine and replay
  solver.logging_type = ceres::SILENT;
  solver.function_tolerance = options.function_tolerance;
  solver.max_solver_time_in_seconds = 1e9;  // never the clock: replays must agree
  return solver;
}

}  // namespace

RelativeJacobians relative_jacobians(double yaw_rad, double dx_m, double dy_m) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  RelativeJacobians j;
  j.by_from << -c, -s, -s * dx_m + c * dy_m, s, -c, -c * dx_m - s * dy_m, 0, 0, -1;
  j.by_to << c, s, 0, -s, c, 0, 0, 0, 1;
  return j;
}

Eigen::Vector3d relative_error(const RelativeFactor& factor, const Transform2<Map, Base>& from,
                               const Transform2<Map, Base>& to) {
  return pose_difference(from.inverse() * to, factor.motion);
}

bool optimise_graph(std::vector<Transform2<Map, Base>>& poses, const std::vector<RelativeFactor>& relative,
                    const std::vector<UnaryFactor>& unary, const GraphOptions& options) {
  if (poses.empty() || (relative.empty() && unary.empty())) {
    return true;
  }
  std::vector<std::array<double, 3>> state;
  state.reserve(poses.size());
  for (const auto& pose : poses) {
    state.push_back({pose.x_m(), pose.y_m(), pose.yaw_rad()});
  }
  ceres::Problem problem;
  const auto block = [&state](int node) { return state[static_cast<std::size_t>(node)].data(); };
  for (const RelativeFactor& f : relative) {
    ceres::LossFunction* loss = f.loop ? new ceres::CauchyLoss(options.loop_loss) : nullptr;
    problem.AddResidualBlock(new RelativeCost(f), loss, block(f.from), block(f.to));
  }
  for (const UnaryFactor& f : unary) {
    problem.AddResidualBlock(new UnaryCost(f), nullptr, block(f.node));
  }
  if (unary.empty()) {
    problem.SetParameterBlockConstant(block(relative.front().from));
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    return false;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i] = Transform2<Map, Base>(state[i][0], state[i][1], state[i][2]);
  }
  return true;
}

}  // namespace madori::localization
