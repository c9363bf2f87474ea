#include "localization/ndt_map/map_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Map>;

/// A Gaussian with its floors.
struct Shape {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
};

Shape shape_of(const CellGaussian& g) {
  const GaussianAxes a = g.axes();
  const Eigen::Vector2d n(a.normal_x, a.normal_y);
  const Eigen::Vector2d t(n.y(), -n.x());
  return {{g.x_m, g.y_m}, a.small_m2 * n * n.transpose() + a.large_m2 * t * t.transpose()};
}

/// A level of the target with its floors, by the same index as its cells.
struct Level {
  const GaussianLevel& target;
  std::vector<Shape> source;
};

/// The sum at a pose, and what leads uphill.
struct Sum {
  double score = 0.0;
  int matched = 0;
  double chi2 = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

void add_cell(Sum& sum, const Shape& source, const GaussianLevel& target, const Pose& pose) {
  Eigen::Matrix2d turn;
  turn << pose.cos_yaw(), -pose.sin_yaw(), pose.sin_yaw(), pose.cos_yaw();
  const Eigen::Vector2d r = turn * source.mean;
  const Eigen::Vector2d p = r + Eigen::Vector2d(pose.x_m(), pose.y_m());
  const Eigen::Matrix2d own = turn * source.covariance * turn.transpose();
  const CellPlace at = target.place_of(p.x(), p.y());
  double nearest = std::numeric_limits<double>::infinity();
  Eigen::Matrix<double, 2, 3> slope;
  slope << 1.0, 0.0, -r.y(), 0.0, 1.0, r.x();
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      const CellGaussian* near = target.find({at.column + dx, at.row + dy});
      if (near == nullptr) continue;
      const Shape other = shape_of(*near);
      const Eigen::Matrix2d information = (own + other.covariance).inverse();
      const Eigen::Vector2d d = p - other.mean;
      const double squared = d.dot(information * d);
      nearest = std::min(nearest, squared);
      const double e = std::exp(-0.5 * squared);
      if (!(e > 1e-9)) continue;
      sum.score += e;
      sum.gradient += e * slope.transpose() * information * d;
      sum.hessian += e * slope.transpose() * information * slope;
    }
  if (nearest < 9.0) {
    ++sum.matched;
    sum.chi2 += nearest;
  }
}

Sum sum_at(const Level& level, const Pose& pose) {
  Sum sum;
  for (const Shape& s : level.source) add_cell(sum, s, level.target, pose);
  return sum;
}

struct Climb {
  Pose pose;
  Sum sum;
  bool converged = false;
};

/// Levenberg-Marquardt uphill: a step that does not raise the sum is tried again shorter.
Climb climb(const Level& level, const Pose& from, const MapRegistrationOptions& options) {
  Climb c{from, sum_at(level, from), false};
  double damping = 1e-3;
  for (int i = 0; i < options.max_iterations && !c.converged; ++i) {
    if (c.sum.hessian.isZero()) break;  // nothing meets
    Eigen::Matrix3d damped = c.sum.hessian;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-9;
    const Eigen::Vector3d step = -damped.ldlt().solve(c.sum.gradient);
    c.converged =
        std::hypot(step[0], step[1]) < options.step_limit_m && std::abs(step[2]) < options.step_limit_rad;
    const Pose next(c.pose.x_m() + step[0], c.pose.y_m() + step[1], c.pose.yaw_rad() + step[2]);
    const Sum there = sum_at(level, next);
    if (there.score > c.sum.score) {
      c.pose = next;
      c.sum = there;
      damping = std::max(1e-6, 0.3 * damping);
    } else {
      damping = std::min(1e6, 8.0 * damping);
    }
  }
  return c;
}

std::vector<Level> levels_of(const GaussianPyramid& target, const GaussianPyramid& source) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < GaussianPyramid::kLevels; ++i) {
    levels.push_back({target.level(i), {}});
    for (const CellGaussian& g : source.level(i).cells()) levels.back().source.push_back(shape_of(g));
  }
  return levels;
}

/// Around the guess in steps of half a cell.
std::vector<Pose> starts(const Pose& guess, const GaussianPyramid& source,
                         const MapRegistrationOptions& options) {
  const double step_m = 0.5 * source.level(options.first_level).cell_m();
  const double step_rad = step_m / options.reach_m;
  const int shifts = static_cast<int>(std::ceil(options.half_m / step_m));
  const int turns = static_cast<int>(std::ceil(options.half_rad / step_rad));
  std::vector<Pose> found;
  for (int turn = -turns; turn <= turns; ++turn)
    for (int i = -shifts; i <= shifts; ++i)
      for (int k = -shifts; k <= shifts; ++k)
        found.emplace_back(guess.x_m() + i * step_m, guess.y_m() + k * step_m,
                           guess.yaw_rad() + turn * step_rad);
  return found;
}

/// The best starts, best first, by their sum at the level at which all are looked at.
std::vector<Pose> best_starts(const Level& level, const std::vector<Pose>& all, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < all.size(); ++i) order.emplace_back(-sum_at(level, all[i]).score, i);
  std::sort(order.begin(), order.end());
  std::vector<Pose> best;
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) best.push_back(all[order[i].second]);
  return best;
}

}  // namespace

MapRegistration lay_on(const GaussianPyramid& target, const GaussianPyramid& source,
                       const Transform2<Map, Map>& guess, const MapRegistrationOptions& options) {
  MapRegistration best{guess.x_m(), guess.y_m(), guess.yaw_rad()};
  if (target.empty() || source.empty()) return best;
  const std::vector<Level> levels = levels_of(target, source);
  best.score = -1.0;
  for (const Pose& start :
       best_starts(levels[options.first_level], starts(guess, source, options), options.carried)) {
    Climb c{start, {}, false};
    for (std::size_t level = options.first_level + 1; level-- > 0;) c = climb(levels[level], c.pose, options);
    const double score = c.sum.score / static_cast<double>(levels[0].source.size());
    if (score <= best.score) continue;
    best = {c.pose.x_m(), c.pose.y_m(),  c.pose.yaw_rad(), c.converged && c.sum.matched > 2,
            score,        c.sum.matched, c.sum.chi2,       c.sum.hessian};
  }
  return best;
}

}  // namespace madori::localization
