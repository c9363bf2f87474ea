#include "localization/mounting/mounting_problem.hpp"

#include <ceres/ceres.h>

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/angle.hpp"
#include "core/median.hpp"

namespace madori::localization {
namespace {

using Parameters = std::array<double, 3>;

constexpr double kWheelPrior = 0.03;  // no wheel's size is believed wronger than that
constexpr double kPlacePriorM = 1.0;  // of the given mounting
constexpr double kYawPriorRad = 1.0;
constexpr double kSlipM = 0.002;     // of a wheel's way, metres a root-metre
constexpr double kStandsM = 0.0003;  // what encoder counts and clocks leave open
constexpr double kLossSigmas = 2.0;
constexpr int kFewestSightings = 4;

/// The wheels' motion between two poses, with wheels that are not as large as believed.
struct WheelCost {
  std::vector<std::array<double, 2>> pieces;
  WheelGeometry wheels;
  double sigma_m = 1.0, sigma_rad = 1.0;

  template <class T>
  bool operator()(const T* from, const T* to, const T* too_large, T* residual) const {
    T x(0.0), y(0.0), yaw(0.0);
    for (const auto& [left_rad, right_rad] : pieces) {
      const T left = (1.0 + too_large[0]) * (wheels.left_radius_m * left_rad);
      const T right = (1.0 + too_large[1]) * (wheels.right_radius_m * right_rad);
      const T turn = (right - left) / (2.0 * wheels.half_separation_m * (1.0 + too_large[2]));
      const T along = 0.5 * (left + right), towards = yaw + 0.5 * turn;
      x += along * cos(towards);
      y += along * sin(towards);
      yaw += turn;
    }
    const T c = cos(from[2]), s = sin(from[2]);
    const T dx = to[0] - from[0], dy = to[1] - from[1];
    residual[0] = (c * dx + s * dy - x) / sigma_m;
    residual[1] = (-s * dx + c * dy - y) / sigma_m;
    residual[2] = (to[2] - from[2] - yaw) / sigma_rad;
    return true;
  }
};

/// A piece on its wall: the two points that tell its line as all its returns do.
struct PieceCost {
  WallPiece piece;
  RoomWall wall;
  double root_weight;

  template <class T>
  bool operator()(const T* base, const T* mount, const T* line, T* residual) const {
    const T normal = wall.normal_rad + line[0], offset = wall.offset_m + line[1];
    const T nx = cos(normal), ny = sin(normal);
    const T cm = cos(mount[2]), sm = sin(mount[2]), cb = cos(base[2]), sb = sin(base[2]);
    for (int i = 0; i < 2; ++i) {
      const double along = i == 0 ? -piece.spread_m : piece.spread_m;
      const double lx = piece.centre.x_m - along * piece.normal_y;
      const double ly = piece.centre.y_m + along * piece.normal_x;
      const T bx = cm * lx - sm * ly + mount[0], by = sm * lx + cm * ly + mount[1];
      const T x = cb * bx - sb * by + base[0], y = sb * bx + cb * by + base[1];
      residual[i] = root_weight * (nx * (x - wall.about.x_m) + ny * (y - wall.about.y_m) - offset);
    }
    return true;
  }
};

struct PriorCost {
  Parameters at, sigma;
  template <class T>
  bool operator()(const T* p, T* residual) const {
    for (int i = 0; i < 3; ++i) residual[i] = (p[i] - at[i]) / sigma[i];
    return true;
  }
};

Transform2<Room, Base> pose_of(const CalibrationSweep& sweep) {
  return {sweep.room_from_base[0], sweep.room_from_base[1], sweep.room_from_base[2]};
}

struct Sighting {
  std::size_t sweep, wall;
  WallPiece piece;
};

/// The walls as each lidar sees them from the poses at hand, and who saw which.
std::vector<std::vector<Sighting>> put_together(const CalibrationState& state, const WallGates& gates,
                                                std::vector<RoomWalls>& walls) {
  std::vector<std::vector<Sighting>> sightings(state.base_from_lidar.size());
  walls.assign(state.base_from_lidar.size(), {});
  for (std::size_t k = 0; k < state.sweeps.size(); ++k) {
    const CalibrationSweep& sweep = state.sweeps[k];
    const auto& mount = state.base_from_lidar[sweep.lidar];
    const Transform2<Room, Lidar> pose =
        pose_of(sweep) * Transform2<Base, Lidar>(mount[0], mount[1], mount[2]);
    for (const WallPiece& piece : sweep.pieces)
      sightings[sweep.lidar].push_back({k, walls[sweep.lidar].add(piece, pose, gates, k), piece});
  }
  return sightings;
}

/// Of the problem as it stands: the normal equations' inverse in the columns of some `wanted` blocks of
/// three.
bool covariances(ceres::Problem& problem, const std::vector<double*>& wanted,
                 std::vector<Eigen::Matrix3d>& out) {
  ceres::Problem::EvaluateOptions options;
  problem.GetParameterBlocks(&options.parameter_blocks);
  std::erase_if(options.parameter_blocks,
                [&](double* block) { return problem.IsParameterBlockConstant(block); });
  ceres::CRSMatrix crs;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &crs)) return false;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
      crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(),
      crs.cols.data(), crs.values.data());
  const Eigen::SparseMatrix<double> normal = Eigen::SparseMatrix<double>(jacobian.transpose() * jacobian);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
  if (factor.info() != Eigen::Success) return false;
  out.assign(wanted.size(), Eigen::Matrix3d::Zero());
  int column = 0;
  for (double* block : options.parameter_blocks) {
    const auto found = std::ranges::find(wanted, block);
    if (found != wanted.end()) {
      Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(crs.num_cols, 3);
      unit.block<3, 3>(column, 0).setIdentity();
      const Eigen::MatrixXd solved = factor.solve(unit);
      out[static_cast<std::size_t>(found - wanted.begin())] = solved.block<3, 3>(column, 0);
    }
    column += problem.ParameterBlockSize(block);
  }
  return true;
}

/// Builds the problem around the state, which Ceres then improves in place.
class MountingProblem {
 public:
  MountingProblem(CalibrationState& state, const std::vector<LidarModel>& believed, const WallGates& gates)
      : state_(state), believed_(believed), sightings_(put_together(state, gates, walls_)) {
    for (auto& mount : state_.base_from_lidar) mounts_.push_back(mount.data());
  }

  void add_wheels(const WheelPath& path) {
    for (std::size_t k = 0; k + 1 < state_.sweeps.size(); ++k) {
      auto& from = state_.sweeps[k];
      auto& to = state_.sweeps[k + 1];
      auto cost = std::make_unique<WheelCost>();
      cost->pieces = path.pieces(from.end, to.end);
      cost->wheels = path.wheels();
      double way_m = 0.0;
      for (const auto& [left, right] : cost->pieces)
        way_m += std::abs(left) * cost->wheels.left_radius_m + std::abs(right) * cost->wheels.right_radius_m;
      cost->sigma_m = std::hypot(kStandsM, kSlipM * std::sqrt(0.5 * way_m));
      cost->sigma_rad = cost->sigma_m / cost->wheels.half_separation_m;
      wheel_blocks_.push_back(problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<WheelCost, 3, 3, 3, 3>(cost.release()), nullptr,
          from.room_from_base.data(), to.room_from_base.data(), state_.wheels.data()));
    }
  }

  void add_pieces() {
    lines_.resize(walls_.size());
    for (std::size_t lidar = 0; lidar < walls_.size(); ++lidar) {
      const auto& walls = walls_[lidar].walls();
      lines_[lidar].resize(walls.size());
      pieces_.push_back(sightings_[lidar].size());
      std::erase_if(sightings_[lidar],
                    [&](const Sighting& s) { return walls[s.wall].sightings < kFewestSightings; });
      for (const Sighting& s : sightings_[lidar]) {
        auto* cost = new ceres::AutoDiffCostFunction<PieceCost, 2, 3, 3, 2>(
            new PieceCost{s.piece, walls[s.wall], std::sqrt(0.5 * piece_weight(s.piece, believed_[lidar]))});
        problem_.AddResidualBlock(cost, new ceres::CauchyLoss(kLossSigmas),
                                  state_.sweeps[s.sweep].room_from_base.data(), mounts_[lidar],
                                  lines_[lidar][s.wall].data());
      }
    }
  }

  /// What keeps in place whatever nothing tells.
  void add_priors() {
    for (std::size_t lidar = 0; lidar < mounts_.size(); ++lidar) {
      const LidarMounting& m = believed_[lidar].mounting;
      const double turns = std::round((mounts_[lidar][2] - m.yaw_rad) / (2.0 * kPi));
      add_prior(mounts_[lidar], {m.x_m, m.y_m, m.yaw_rad + 2.0 * kPi * turns},
                {kPlacePriorM, kPlacePriorM, kYawPriorRad});
    }
    add_prior(state_.wheels.data(), {}, {kWheelPrior, kWheelPrior, kWheelPrior});
    problem_.SetParameterBlockConstant(state_.sweeps.front().room_from_base.data());
  }

  CalibrationQuality solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 12;
    options.function_tolerance = 1e-5;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    CalibrationQuality quality;
    auto wanted = mounts_;
    wanted.push_back(state_.wheels.data());
    quality.good = summary.IsSolutionUsable() && covariances(problem_, wanted, quality.covariance);
    if (quality.good) judge_wheels(quality);
    for (std::size_t lidar = 0; lidar < walls_.size(); ++lidar) {
      const double pieces = static_cast<double>(std::max<std::size_t>(pieces_[lidar], 1));
      quality.on_walls.push_back(static_cast<double>(sightings_[lidar].size()) / pieces);
      quality.residual_m.push_back(residual_m(lidar));
      quality.walls.push_back(found_walls(lidar));
    }
    return quality;
  }

 private:
  void add_prior(double* block, const Parameters& at, const Parameters& sigma) {
    problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PriorCost, 3, 3>(new PriorCost{at, sigma}),
                              nullptr, block);
  }
  [[nodiscard]] double way_off() const {
    double squares = 0.0;
    for (const auto block : wheel_blocks_) {
      double cost = 0.0;
      problem_.EvaluateResidualBlock(block, false, &cost, nullptr, nullptr);
      squares += 2.0 * cost;
    }
    return std::sqrt(squares / static_cast<double>(3 * wheel_blocks_.size()));
  }
  void judge_wheels(CalibrationQuality& quality) const {
    quality.way_off = way_off();
    const Eigen::Map<const Eigen::Vector3d> too_large(state_.wheels.data());
    quality.sizes_off = too_large.norm() / (std::sqrt(3.0) * kWheelPrior);
    // Wheels that err more than they were believed to make everything less certain by as much.
    for (auto& covariance : quality.covariance) covariance *= std::pow(std::max(1.0, quality.way_off), 2);
    quality.wheel_sigma = quality.covariance.back().diagonal().cwiseMax(0.0).cwiseSqrt();
    quality.covariance.pop_back();
  }
  /// Of the middles of its pieces, the median as an RMS.
  [[nodiscard]] double residual_m(std::size_t lidar) const {
    std::vector<double> off;
    for (const Sighting& s : sightings_[lidar]) {
      const PieceCost cost{s.piece, walls_[lidar].walls()[s.wall], 1.0};
      std::array<double, 2> ends{};
      cost(state_.sweeps[s.sweep].room_from_base.data(), state_.base_from_lidar[lidar].data(),
           lines_[lidar][s.wall].data(), ends.data());
      off.push_back(std::abs(0.5 * (ends[0] + ends[1])));
    }
    return off.empty() ? 0.0 : 1.4826 * median_of(off);
  }
  [[nodiscard]] std::vector<RoomWall> found_walls(std::size_t lidar) const {
    std::vector<RoomWall> found;
    for (std::size_t i = 0; i < lines_[lidar].size(); ++i) {
      RoomWall wall = walls_[lidar].walls()[i];
      if (wall.sightings < kFewestSightings) continue;
      wall.normal_rad += lines_[lidar][i][0];
      wall.offset_m += lines_[lidar][i][1];
      found.push_back(wall);
    }
    return found;
  }

  CalibrationState& state_;
  const std::vector<LidarModel>& believed_;
  std::vector<RoomWalls> walls_;                           ///< by lidar
  std::vector<std::vector<Sighting>> sightings_;           ///< by lidar
  std::vector<std::vector<std::array<double, 2>>> lines_;  ///< what each wall's normal and offset change by
  std::vector<double*> mounts_;
  std::vector<std::size_t> pieces_;                   ///< by lidar, on walls or not
  std::vector<ceres::ResidualBlockId> wheel_blocks_;  ///< what the wheels turned
  ceres::Problem problem_;
};

}  // namespace

CalibrationQuality solve_mounting(CalibrationState& state, const WheelPath& path,
                                  const std::vector<LidarModel>& believed, const WallGates& gates) {
  if (state.sweeps.size() < 2) return {};
  MountingProblem problem(state, believed, gates);
  problem.add_wheels(path);
  problem.add_pieces();
  problem.add_priors();
  return problem.solve();
}

}  // namespace madori::localization
