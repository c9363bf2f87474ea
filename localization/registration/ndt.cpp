#include "localization/registration/ndt.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/registration/point_icp.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

struct Moments {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

NdtMap::Cell cell_of(const Moments& m) {
  constexpr double kLeastPoints = 3.0;
  constexpr double kFlattest = 0.05;
  NdtMap::Cell cell;
  if (m.n < kLeastPoints) return cell;
  cell.mean_x = m.x / m.n;
  cell.mean_y = m.y / m.n;
  const double xx = m.xx / m.n - cell.mean_x * cell.mean_x;
  const double xy = m.xy / m.n - cell.mean_x * cell.mean_y;
  const double yy = m.yy / m.n - cell.mean_y * cell.mean_y;
  const double middle = 0.5 * (xx + yy);
  const double spread = std::hypot(0.5 * (xx - yy), xy);
  const double large = middle + spread;
  if (large <= 0.0) return cell;
  const double small = std::max(middle - spread, kFlattest * large);
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  cell.a = c * c / large + s * s / small;
  cell.b = c * s * (1.0 / large - 1.0 / small);
  cell.c = s * s / large + c * c / small;
  cell.used = true;
  return cell;
}

mapping::GridFrame bounds(std::span<const Point2<Map>> points, double cell_m, int grid) {
  Point2<Map> low = points.empty() ? Point2<Map>{} : points.front();
  Point2<Map> high = low;
  for (const Point2<Map>& p : points) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  mapping::GridFrame frame;
  frame.cell_m = cell_m;
  frame.origin = {low.x_m - (1.0 + 0.5 * (grid & 1)) * cell_m, low.y_m - (1.0 + 0.5 * (grid >> 1)) * cell_m};
  frame.width = static_cast<int>((high.x_m - frame.origin.x_m) / cell_m) + 2;
  frame.height = static_cast<int>((high.y_m - frame.origin.y_m) / cell_m) + 2;
  return frame;
}

/// Gradient and Gauss-Newton Hessian of the negative score in (x, y, yaw).
struct Newton {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

/// Adds one point, `r` turned but not moved, in one cell: Biber and Strasser, Eq. (9)-(13).
void add(Newton& sum, const NdtMap::Cell& cell, double rx, double ry, const Pose& pose, double weight) {
  const double qx = rx + pose.x_m() - cell.mean_x;
  const double qy = ry + pose.y_m() - cell.mean_y;
  const double cx = cell.a * qx + cell.b * qy;
  const double cy = cell.b * qx + cell.c * qy;
  const double e = weight * std::exp(-0.5 * (qx * cx + qy * cy));
  if (!(e > 1e-9)) return;
  const Eigen::Vector3d slope(cx, cy, -cx * ry + cy * rx);
  const double tx = cell.a * -ry + cell.b * rx;
  const double ty = cell.b * -ry + cell.c * rx;
  Eigen::Matrix3d h;
  h << cell.a, cell.b, tx, cell.b, cell.c, ty, tx, ty, -ry * tx + rx * ty;
  sum.gradient += e * slope;
  sum.hessian += e * h;
}

Newton derivatives(const ScanPoints& points, const NdtMap& map, int level, const Pose& pose) {
  Newton sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double rx = pose.cos_yaw() * points.x_m[i] - pose.sin_yaw() * points.y_m[i];
    const double ry = pose.sin_yaw() * points.x_m[i] + pose.cos_yaw() * points.y_m[i];
    for (int grid = 0; grid < 4; ++grid)
      if (const NdtMap::Cell* cell = map.find(level, grid, rx + pose.x_m(), ry + pose.y_m()))
        add(sum, *cell, rx, ry, pose, points.weight_of(i));
  }
  return sum;
}

/// Newton's step, made to go downhill where the Hessian is not positive definite, and not farther than half a
/// cell.
Eigen::Vector3d newton_step(const Newton& n) {
  double damping = 1e-9 * (1.0 + n.hessian.diagonal().cwiseAbs().maxCoeff());
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int tries = 0; tries < 40; ++tries, damping *= 4.0) {
    const Eigen::LLT<Eigen::Matrix3d> factor(n.hessian + damping * Eigen::Matrix3d::Identity());
    if (factor.info() != Eigen::Success) continue;
    step = -factor.solve(n.gradient);
    break;
  }
  constexpr double kFarthestM = 0.3;
  constexpr double kFarthestRad = 0.05;
  const double ratio = std::max(std::hypot(step[0], step[1]) / kFarthestM, std::abs(step[2]) / kFarthestRad);
  return ratio > 1.0 ? Eigen::Vector3d(step / ratio) : step;
}

}  // namespace

NdtMap::NdtMap(std::span<const Point2<Map>> points, std::array<double, 3> cells_m)
    : points_(std::vector<Point2<Map>>(points.begin(), points.end()), 0.0) {
  for (std::size_t level = 0; level < kLevels; ++level)
    for (int g = 0; g < 4; ++g) {
      Grid& grid = grids_[level][static_cast<std::size_t>(g)];
      grid.frame = bounds(points, cells_m[level], g);
      std::vector<Moments> moments(grid.frame.cells());
      for (const Point2<Map>& p : points) {
        Moments& m = moments[static_cast<std::size_t>(grid.frame.find(p))];
        m.n += 1.0, m.x += p.x_m, m.y += p.y_m;
        m.xx += p.x_m * p.x_m, m.xy += p.x_m * p.y_m, m.yy += p.y_m * p.y_m;
      }
      for (const Moments& m : moments) grid.cells.push_back(cell_of(m));
    }
}

const NdtMap::Cell* NdtMap::find(int level, int grid, double x_m, double y_m) const {
  const Grid& g = grids_[static_cast<std::size_t>(level)][static_cast<std::size_t>(grid)];
  const std::int64_t index = g.frame.find({x_m, y_m});
  if (index < 0 || !g.cells[static_cast<std::size_t>(index)].used) return nullptr;
  return &g.cells[static_cast<std::size_t>(index)];
}

RegistrationResult ndt(const ScanPoints& points, const NdtMap& map, const Pose& initial,
                       const NdtOptions& options) {
  Pose pose = initial;
  int iterations = 0;
  bool converged = false;
  for (int level = 0; level < NdtMap::kLevels; ++level) {
    converged = false;
    for (int i = 0; i < options.max_iterations && !converged; ++i, ++iterations) {
      const Newton n = derivatives(points, map, level, pose);
      if (n.hessian.isZero()) break;  // no point falls into any cell
      const Eigen::Vector3d step = newton_step(n);
      pose = Pose(pose.x_m() + step[0], pose.y_m() + step[1], pose.yaw_rad() + step[2]);
      converged =
          std::hypot(step[0], step[1]) < options.step_limit_m && std::abs(step[2]) < options.step_limit_rad;
    }
  }
  RegistrationResult result = point_fit(points, map.points(), pose);
  result.converged = converged && result.inliers > 2;
  result.iterations = iterations;
  return result;
}

}  // namespace madori::localization
