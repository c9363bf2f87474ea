#include "localization/memory/local_map.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

constexpr double kCellM = 0.2;

}  // namespace

void LocalMap::build(const std::vector<Piece>& pieces, const Point2<Map>& centre, double radius_m) {
  has_grid_ = false;
  points_.clear();
  cell_begin_.clear();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const SurfacePoint& p : pieces[i].scan->points) {
      const SurfacePoint q = moved(pieces[i].map_from_base, p);
      if (std::hypot(q.x_m - centre.x_m, q.y_m - centre.y_m) < radius_m) {
        points_.push_back({q, static_cast<int>(i)});
      }
    }
  }
  build_index();
  weigh();
}

/// What several keyframes saw in one cell stays; what one saw may have been a passer-by, or the first sight
/// of a room: halved, not less (at a fifth the Intel log without a drawing scored 0.148 m instead of 0.112).
void LocalMap::weigh() {
  for (std::size_t cell = 0; cell + 1 < cell_begin_.size(); ++cell) {
    int pieces = 0;
    int last = -1;
    for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) {
      pieces += points_[i].piece != last ? 1 : 0;  // a cell keeps the order of the pieces
      last = points_[i].piece;
    }
    const double weight = pieces >= 3 ? 1.0 : (pieces == 2 ? 0.8 : 0.5);
    for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) {
      points_[i].weight = weight;
    }
  }
}

void LocalMap::build_index() {
  if (points_.empty()) {
    return;
  }
  Point2<Map> low{points_[0].point.x_m, points_[0].point.y_m};
  Point2<Map> high = low;
  for (const Entry& e : points_) {
    low = {std::min(low.x_m, e.point.x_m), std::min(low.y_m, e.point.y_m)};
    high = {std::max(high.x_m, e.point.x_m), std::max(high.y_m, e.point.y_m)};
  }
  origin_ = {low.x_m - kCellM, low.y_m - kCellM};
  width_ = static_cast<int>((high.x_m - origin_.x_m) / kCellM) + 2;
  height_ = static_cast<int>((high.y_m - origin_.y_m) / kCellM) + 2;
  const auto cell_of = [this](const Entry& e) {
    return static_cast<std::size_t>((e.point.y_m - origin_.y_m) / kCellM) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>((e.point.x_m - origin_.x_m) / kCellM);
  };
  cell_begin_.assign(static_cast<std::size_t>(width_) * height_ + 1, 0);
  for (const Entry& p : points_) {
    ++cell_begin_[cell_of(p) + 1];
  }
  for (std::size_t i = 1; i < cell_begin_.size(); ++i) {
    cell_begin_[i] += cell_begin_[i - 1];
  }
  sorted_.resize(points_.size());
  next_.assign(cell_begin_.begin(), cell_begin_.end() - 1);
  for (const Entry& p : points_) {
    sorted_[next_[cell_of(p)]++] = p;
  }
  std::swap(points_, sorted_);
}

const LocalMap::Entry* LocalMap::nearest(double x_m, double y_m, double normal_x, double normal_y,
                                         double reach_m) const {
  constexpr double kRoundingM = 1e-9;  // a point at a cell's border may be counted to either
  const double u = (x_m - origin_.x_m) / kCellM;
  const double v = (y_m - origin_.y_m) / kCellM;
  const double reach = reach_m / kCellM;
  if (!(u >= -reach && u <= width_ + reach && v >= -reach && v <= height_ + reach)) return nullptr;
  const int row = static_cast<int>(std::floor(v)), column = static_cast<int>(std::floor(u));
  const bool directed = normal_x != 0.0 || normal_y != 0.0;
  const Entry* best = nullptr;
  double best_sq = reach_m * reach_m;
  const auto look_through = [&](int y, int x_low, int x_high) {
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (std::uint32_t i = cell_begin_[first + x_low]; i < cell_begin_[first + x_high + 1]; ++i) {
      const SurfacePoint& q = points_[i].point;
      const double sq = (q.x_m - x_m) * (q.x_m - x_m) + (q.y_m - y_m) * (q.y_m - y_m);
      if (sq < best_sq && q.has_normal() &&
          (!directed || q.normal_x * normal_x + q.normal_y * normal_y > kSameSurfaceCosine)) {
        best_sq = sq;
        best = &points_[i];
      }
    }
  };
  const bool inside = row >= 0 && row < height_ && column >= 0 && column < width_;
  if (inside) look_through(row, column, column);  // most are near: little else need be looked through then
  /// False where the row, and those behind it, are too far.
  const auto look = [&](int y) {
    const double beside_m =
        std::max({0.0, kCellM * (y - v) - kRoundingM, kCellM * (v - (y + 1)) - kRoundingM});
    const double left_sq = best_sq - beside_m * beside_m;
    if (left_sq <= 0.0) return false;
    if (y < 0 || y >= height_) return true;
    const double half = (std::sqrt(left_sq) + kRoundingM) / kCellM;
    const int x_low = std::max(0, static_cast<int>(std::floor(u - half)));
    const int x_high = std::min(width_ - 1, static_cast<int>(std::floor(u + half)));
    if (x_low > x_high) return true;
    if (y == row && inside) {
      if (x_low < column) look_through(y, x_low, column - 1);
      if (x_high > column) look_through(y, column + 1, x_high);
    } else {
      look_through(y, x_low, x_high);
    }
    return true;
  };
  bool below = look(row), above = true;
  for (int k = 1; below || above; ++k) {
    above = above && look(row + k);
    below = below && look(row - k);
  }
  return best;
}

SearchResult LocalMap::search(const SurfaceScan& scan, const Transform2<Map, Base>& prediction,
                              const SearchWindow& window) const {
  if (!has_grid_) {
    marks_.clear();
    marks_.reserve(points_.size());
    for (const Entry& e : points_) {
      marks_.push_back({{e.point.x_m, e.point.y_m}, e.weight});
    }
    grid_.build(marks_);
    has_grid_ = true;
  }
  return grid_.search(scan, prediction, window);
}

namespace {

/// Sums of one Gauss-Newton step.
struct NormalEquations {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  int covered = 0;
  int inliers = 0;
  double trust_sum = 0.0;

  void add(double residual, const Eigen::Vector3d& jacobian, double kernel_m, double trust) {
    const double ratio = residual / kernel_m;
    const double weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));  // Geman-McClure
    const double information = trust * weight / (kResidualSigmaM * kResidualSigmaM);
    trust_sum += trust;
    hessian += information * jacobian * jacobian.transpose();
    gradient += information * residual * jacobian;
    if (std::abs(residual) < 0.1) ++inliers;
  }
};

}  // namespace

MatchResult LocalMap::refine(const SurfaceScan& scan, const Transform2<Map, Base>& start,
                             const MatchPrior& prior, const ExtraPull& extra, MatchStart from) const {
  MatchResult result;
  result.map_from_base = start;
  if (empty() || scan.points.empty()) {
    return result;
  }
  constexpr int kMaxIterations = 20;
  constexpr int kShrunk = 6;  // from here on reach and kernel are at their least
  double mean_trust = 1.0;    // where nothing is confirmed yet, all of it counts alike
  for (int i = from == MatchStart::Near ? kShrunk - 1 : 0; i < kMaxIterations; ++i) {
    const double shrink = std::max(0.0, 1.0 - i / double{kShrunk});
    const double reach_m = 0.3 + 0.3 * shrink;
    const double kernel_m = 0.08 + 0.2 * shrink;
    NormalEquations sums;
    const Transform2<Map, Base>& pose = result.map_from_base;
    for (const SurfacePoint& p : scan.points) {
      const SurfacePoint q = moved(pose, p);
      const Entry* found = nearest(q.x_m, q.y_m, q.normal_x, q.normal_y, reach_m);
      if (found == nullptr) {
        continue;
      }
      const SurfacePoint* m = &found->point;
      ++sums.covered;
      const double residual = m->normal_x * (q.x_m - m->x_m) + m->normal_y * (q.y_m - m->y_m);
      const Eigen::Vector3d jacobian(
          m->normal_x, m->normal_y, -m->normal_x * (q.y_m - pose.y_m()) + m->normal_y * (q.x_m - pose.x_m()));
      sums.add(residual, jacobian, kernel_m, found->weight / mean_trust);
    }
    if (sums.covered > 0) {
      mean_trust *= std::max(0.2, sums.trust_sum / sums.covered);
    }
    if (extra && i >= 4) {  // once near: far off, it would draw to the wrong walls
      extra(pose, sums.hessian, sums.gradient);
    }
    const Eigen::Vector3d off = pose_difference(pose, prior.map_from_base);
    // Slipping wheels are far off at once: beyond three sigmas the prediction lets go (Cauchy).
    const Eigen::Matrix3d lean = prior.information / (1.0 + off.dot(prior.information * off) / 9.0);
    const Eigen::Matrix3d total = sums.hessian + lean + 1e-6 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d slope = sums.gradient + lean * off;
    const Eigen::Vector3d step = -total.ldlt().solve(slope);
    result.information = sums.hessian;
    const double points = static_cast<double>(scan.points.size());
    result.covered_share = sums.covered / points;
    result.inlier_share = sums.covered > 0 ? static_cast<double>(sums.inliers) / points : 0.0;
    result.map_from_base =
        Transform2<Map, Base>(pose.x_m() + step[0], pose.y_m() + step[1], pose.yaw_rad() + step[2]);
    if (i >= kShrunk && step.head<2>().norm() < 1e-4 && std::abs(step[2]) < 1e-5) {
      result.converged = true;
      break;
    }
  }
  return result;
}

}  // namespace madori::localization
