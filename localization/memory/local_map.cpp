#include "localization/memory/local_map.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/angle.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

constexpr double kCellM = 0.2;   ///< in which keyframes confirm each other, and nearest surfaces are found
constexpr double kSidesM = 0.3;  ///< in which it is noted which ways surfaces look

/// As a cell of `side_m` counted from `origin`, column and row.
std::array<std::size_t, 2> cell_of(const SurfacePoint& p, const Point2<Map>& origin, double side_m) {
  return {static_cast<std::size_t>((p.x_m - origin.x_m) / side_m),
          static_cast<std::size_t>((p.y_m - origin.y_m) / side_m)};
}

/// The eighth of a turn that a direction lies in, 0..7.
unsigned eighth(double x, double y) {
  const bool steep = std::abs(y) > std::abs(x);
  return (y < 0.0 ? 4U : 0U) | (x < 0.0 ? 2U : 0U) | (steep ? 1U : 0U);
}

/// The bit of the way that a surface looks.
std::uint8_t side_of(const SurfacePoint& p) {
  return static_cast<std::uint8_t>(1U << eighth(p.normal_x, p.normal_y));
}

/// Those of what may be the same surface: 45 degrees and a little.
std::uint8_t sides_like(const SurfacePoint& p) {
  static_assert(kSameSurfaceCosine > 0.39, "67.5 degrees would need more of them");
  static const auto table = [] {
    std::array<std::uint8_t, 8> made{};
    for (int k = 0; k < 8; ++k) {
      const auto at = [k](int beside) {
        const double a = (k + beside + 0.5) * kPi / 4.0;
        return eighth(std::cos(a), std::sin(a));
      };
      for (int beside = -2; beside <= 2; ++beside)
        made[at(0)] = static_cast<std::uint8_t>(made[at(0)] | 1U << at(beside));
    }
    return made;
  }();
  return table[eighth(p.normal_x, p.normal_y)];
}

}  // namespace

void LocalMap::build(const std::vector<Piece>& pieces, const Point2<Map>& centre, double radius_m) {
  has_grid_ = false;
  points_.clear();
  surfaces_.clear();
  low_ = {1e9, 1e9}, high_ = {-1e9, -1e9};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const SurfacePoint& p : pieces[i].scan->points) {
      const SurfacePoint q = moved(pieces[i].map_from_base, p);
      if (std::hypot(q.x_m - centre.x_m, q.y_m - centre.y_m) >= radius_m) continue;
      points_.push_back({q, static_cast<int>(i)});
      low_ = {std::min(low_.x_m, q.x_m), std::min(low_.y_m, q.y_m)};
      high_ = {std::max(high_.x_m, q.x_m), std::max(high_.y_m, q.y_m)};
    }
  }
  if (points_.empty()) return;
  low_ = {low_.x_m - kCellM, low_.y_m - kCellM};
  width_ = static_cast<int>((high_.x_m - low_.x_m) / kCellM) + 1;
  height_ = static_cast<int>((high_.y_m - low_.y_m) / kCellM) + 1;
  weigh();
  build_index();
  note_sides();
}

std::size_t LocalMap::index_of(const Entry& e) const {
  const auto [x, y] = cell_of(e.point, low_, kCellM);
  return y * static_cast<std::size_t>(width_) + x;
}

/// What several keyframes saw in one cell stays; what one saw may have been a passer-by, or the first sight
/// of a room: halved, not less (at a fifth the Intel log without a drawing scored 0.148 m instead of 0.112).
void LocalMap::weigh() {
  seen_by_.assign(static_cast<std::size_t>(width_) * height_, {});
  for (const Entry& e : points_) {
    SeenBy& seen = seen_by_[index_of(e)];
    seen.pieces += seen.last != e.piece ? 1 : 0;  // piece after piece
    seen.last = e.piece;
  }
  for (Entry& e : points_) {
    const int pieces = seen_by_[index_of(e)].pieces;
    e.weight = pieces >= 3 ? 1.0 : (pieces == 2 ? 0.8 : 0.5);
  }
}

void LocalMap::build_index() {
  cell_begin_.assign(static_cast<std::size_t>(width_) * height_ + 1, 0);
  for (const Entry& e : points_) {
    if (e.point.has_normal()) ++cell_begin_[index_of(e) + 1];
  }
  for (std::size_t i = 1; i < cell_begin_.size(); ++i) {
    cell_begin_[i] += cell_begin_[i - 1];
  }
  surfaces_.resize(cell_begin_.back());
  next_.assign(cell_begin_.begin(), cell_begin_.end() - 1);
  for (const Entry& e : points_) {
    if (e.point.has_normal()) surfaces_[next_[index_of(e)]++] = e;
  }
}

void LocalMap::note_sides() {
  constexpr int kBorder = kSidesReach + 1;
  const Point2<Map> low{low_.x_m - kBorder * kSidesM, low_.y_m - kBorder * kSidesM};
  const auto cells = [&](double from, double to) {
    return static_cast<std::size_t>((to - from) / kSidesM) + 1 + kBorder;
  };
  sides_width_ = cells(low.x_m, high_.x_m);
  const std::size_t count = sides_width_ * cells(low.y_m, high_.y_m);
  for (auto& within : sides_) within.assign(count, 0);
  for (const Entry& e : surfaces_) {
    const auto [x, y] = cell_of(e.point, low, kSidesM);
    sides_[0][y * sides_width_ + x] |= side_of(e.point);
  }
  sides_low_ = low;
  for (std::size_t k = 1; k < sides_.size(); ++k) {
    const std::vector<std::uint8_t>& from = sides_[k - 1];
    const auto three = [&](std::size_t i) { return from[i - 1] | from[i] | from[i + 1]; };
    for (std::size_t i = sides_width_ + 1; i + sides_width_ + 1 < count; ++i)
      sides_[k][i] = static_cast<std::uint8_t>(three(i - sides_width_) | three(i) | three(i + sides_width_));
  }
}

/// False where no surface within reach looks the same way: most points that have none need no search then.
bool LocalMap::may_be_near(const SurfacePoint& p, double reach_m) const {
  const std::vector<std::uint8_t>& sides = sides_[reach_m > kSidesM ? 2 : 1];
  const double u = (p.x_m - sides_low_.x_m) / kSidesM;
  const double v = (p.y_m - sides_low_.y_m) / kSidesM;
  if (!(u >= 0.0 && u < static_cast<double>(sides_width_) && v >= 0.0)) return false;
  const std::size_t cell =
      static_cast<std::size_t>(std::min(v, 1e6)) * sides_width_ + static_cast<std::size_t>(u);
  return cell < sides.size() && (sides[cell] & (p.has_normal() ? sides_like(p) : 0xFF)) != 0;
}

const LocalMap::Entry* LocalMap::nearest(const SurfacePoint& p, double reach_m, const Entry* before) const {
  assert(reach_m <= kSidesReach * kSidesM);
  constexpr double kRoundingM = 1e-9;  // a point at a cell's border may be counted to either
  if (!may_be_near(p, reach_m)) return nullptr;
  const double u = (p.x_m - low_.x_m) / kCellM;
  const double v = (p.y_m - low_.y_m) / kCellM;
  const int row = static_cast<int>(std::floor(v)), column = static_cast<int>(std::floor(u));
  const bool directed = p.has_normal();
  const Entry* best = nullptr;
  double best_sq = reach_m * reach_m;
  const auto ask = [&](const Entry& e) {
    const SurfacePoint& q = e.point;
    const double sq = (q.x_m - p.x_m) * (q.x_m - p.x_m) + (q.y_m - p.y_m) * (q.y_m - p.y_m);
    if (sq < best_sq &&
        (!directed || q.normal_x * p.normal_x + q.normal_y * p.normal_y > kSameSurfaceCosine)) {
      best_sq = sq;
      best = &e;
    }
  };
  if (before != nullptr) ask(*before);
  const auto look_through = [&](int y, int x_low, int x_high) {
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (std::uint32_t i = cell_begin_[first + x_low]; i < cell_begin_[first + x_high + 1]; ++i)
      ask(surfaces_[i]);
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
  found_.assign(scan.points.size(), nullptr);
  constexpr int kMaxIterations = 20;
  constexpr int kShrunk = 6;  // from here on reach and kernel are at their least
  double mean_trust = 1.0;    // where nothing is confirmed yet, all of it counts alike
  for (int i = from == MatchStart::Near ? kShrunk - 1 : 0; i < kMaxIterations; ++i) {
    const double shrink = std::max(0.0, 1.0 - i / double{kShrunk});
    const double reach_m = 0.3 + 0.3 * shrink;
    const double kernel_m = 0.08 + 0.2 * shrink;
    NormalEquations sums;
    const Transform2<Map, Base>& pose = result.map_from_base;
    for (std::size_t k = 0; k < scan.points.size(); ++k) {
      const SurfacePoint q = moved(pose, scan.points[k]);
      const Entry* const found = found_[k] = nearest(q, reach_m, found_[k]);
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
