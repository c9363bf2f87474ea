#include "localization/registration/cpd.hpp"

#include <algorithm>
#include <cmath>

#include "localization/registration/point_icp.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

template <class T>
std::vector<T> at_most(const std::vector<T>& all, std::size_t most) {
  std::vector<T> some;
  const std::size_t stride = 1 + all.size() / (most + 1);
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

/// The map's points that lie within reach of a scan point as placed.
std::vector<Point2<Map>> near(const PointMap& map, const std::vector<Point2<Base>>& scan, const Pose& pose,
                              double reach_m) {
  std::vector<Point2<Map>> placed;
  placed.reserve(scan.size());
  for (const Point2<Base>& p : scan) placed.push_back(pose * p);
  const PointMap scan_map(placed, 0.0);
  std::vector<Point2<Map>> result;
  for (const Point2<Map>& p : map.points())
    if (scan_map.nearest(p).squared_distance_m2 < reach_m * reach_m) result.push_back(p);
  return result;
}

/// What the E-step leaves for the M-step: sums over all pairs, weighted by the posterior.
struct PosteriorSums {
  double n = 0, xx = 0, xy = 0, yx = 0, yy = 0, dot = 0, cross = 0, x_squared = 0, y_squared = 0;
};

PosteriorSums expectation(const std::vector<Point2<Map>>& x, const std::vector<Point2<Base>>& y,
                          const Pose& pose, double sigma2, double outliers) {
  const auto m = static_cast<double>(x.size());
  const auto n = static_cast<double>(y.size());
  const double uniform = 2.0 * kPi * sigma2 * outliers / (1.0 - outliers) * m / n;
  std::vector<double> likely(x.size());
  PosteriorSums s;
  for (const Point2<Base>& q : y) {
    const Point2<Map> moved = pose * q;
    double sum = uniform;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double dx = x[i].x_m - moved.x_m;
      const double dy = x[i].y_m - moved.y_m;
      likely[i] = std::exp(-0.5 * (dx * dx + dy * dy) / sigma2);
      sum += likely[i];
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double p = likely[i] / sum;
      if (p < 1e-12) continue;
      s.n += p;
      s.xx += p * x[i].x_m, s.xy += p * x[i].y_m;
      s.yx += p * q.x_m, s.yy += p * q.y_m;
      s.dot += p * (q.x_m * x[i].x_m + q.y_m * x[i].y_m);
      s.cross += p * (q.x_m * x[i].y_m - q.y_m * x[i].x_m);
      s.x_squared += p * (x[i].x_m * x[i].x_m + x[i].y_m * x[i].y_m);
      s.y_squared += p * (q.x_m * q.x_m + q.y_m * q.y_m);
    }
  }
  return s;
}

/// The rigid transform that the sums call for, and the variance that is left.
Pose maximization(const PosteriorSums& s, double& sigma2) {
  const double c = s.dot - (s.xx * s.yx + s.xy * s.yy) / s.n;
  const double d = s.cross - (s.yx * s.xy - s.yy * s.xx) / s.n;
  const Pose turn(0.0, 0.0, std::atan2(d, c));
  const Point2<Map> centre = turn * Point2<Base>{s.yx / s.n, s.yy / s.n};
  const double x_spread = s.x_squared - (s.xx * s.xx + s.xy * s.xy) / s.n;
  const double y_spread = s.y_squared - (s.yx * s.yx + s.yy * s.yy) / s.n;
  sigma2 = std::max((x_spread + y_spread - 2.0 * std::hypot(c, d)) / (2.0 * s.n), 1e-12);
  return {s.xx / s.n - centre.x_m, s.xy / s.n - centre.y_m, turn.yaw_rad()};
}

}  // namespace

RegistrationResult cpd(const ScanPoints& points, const PointMap& map, const Pose& initial,
                       const CpdOptions& options) {
  std::vector<Point2<Base>> all;
  all.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) all.push_back(points.point(i));
  const std::vector<Point2<Base>> y = at_most(all, options.most_scan);
  if (y.empty() || map.empty()) return point_fit(points, map, initial);
  const std::vector<Point2<Map>> x = at_most(near(map, y, initial, options.reach_m), options.most_map);
  if (x.empty()) return point_fit(points, map, initial);
  Pose pose = initial;
  double sigma2 = options.reach_m * options.reach_m / 4.0;  // the initial pose is known to about the reach
  bool converged = false;
  int iteration = 0;
  while (iteration < options.max_iterations && !converged) {
    const PosteriorSums sums = expectation(x, y, pose, sigma2, options.outliers);
    ++iteration;
    if (!(sums.n > 1e-6)) break;
    const double before = sigma2;
    pose = maximization(sums, sigma2);
    converged =
        sigma2 < options.sigma_limit_m * options.sigma_limit_m || std::abs(before - sigma2) < 1e-4 * before;
  }
  RegistrationResult result = point_fit(points, map, pose);
  result.converged = converged && pose.is_finite() && result.inliers > 2;
  return result;
}

}  // namespace madori::localization
