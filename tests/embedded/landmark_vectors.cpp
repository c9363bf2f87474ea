#include "tests/embedded/landmark_vectors.hpp"

#include "localization/landmarks/landmark_map.hpp"
#include "localization/landmarks/reductions.hpp"

namespace madori::test {
namespace {

using namespace localization::landmarks;  // NOLINT: a file of figures

constexpr double kQuarter = 0.5 * kHalfTurn_rad;

ScalarPose scalar(double x, double y, double yaw, double u_position, double u_yaw) {
  return {{x, y, yaw}, {u_position * u_position, u_yaw * u_yaw}};
}
ScalarPose on_a_line(double x, double variance) {
  return {{x, 0.0, 0.0}, {variance, variance}};
}

void algebra(VectorReport report) {
  const ScalarPose sum = added(scalar(1.0, 2.0, kQuarter, 0.1, 0.1), scalar(3.0, 1.0, 0.3, 0.2, 0.2));
  report("sum x", sum.motion.x_m, 0.0, 1e-12);
  report("sum y", sum.motion.y_m, 5.0, 1e-12);
  report("sum yaw", sum.motion.yaw_rad, 1.8707963267948966, 1e-12);
  report("sum U", square_root(sum.uncertainty.position_m2), 0.22360679774997896, 1e-12);
  const ScalarPose back = negated(scalar(1.0, 2.0, kQuarter, 0.1, 0.1));
  report("negation x", back.motion.x_m, -2.0, 1e-12);
  report("negation y", back.motion.y_m, 1.0, 1e-12);
  report("negation yaw", back.motion.yaw_rad, -kQuarter, 1e-12);
  const ScalarPose both = fused(on_a_line(1.0, 0.01), on_a_line(1.2, 0.04));
  report("fusion", both.motion.x_m, 1.04, 1e-12);
  report("fusion U", square_root(both.uncertainty.position_m2), 0.08944271909999159, 1e-12);
}

void delta_star(VectorReport report) {
  const StarArms star = star_of_delta(on_a_line(1.0, 0.04), on_a_line(1.0, 0.09), on_a_line(2.3, 0.01));
  report("arm of A", star.from_a.uncertainty.position_m2, 0.04 * 0.01 / 0.14, 1e-12);
  report("arm of B", star.from_b.uncertainty.position_m2, 0.04 * 0.09 / 0.14, 1e-12);
  report("arm of C", star.from_c.uncertainty.position_m2, 0.09 * 0.01 / 0.14, 1e-12);
  report("star A to B", (star.from_a.motion * star.from_b.motion.inverse()).x_m, 1.0857142857142857, 1e-12);
  report("star B to C", (star.from_b.motion * star.from_c.motion.inverse()).x_m, 1.1928571428571428, 1e-12);
  report("star A to C", (star.from_a.motion * star.from_c.motion.inverse()).x_m, 2.2785714285714285, 1e-12);
}

/// Unit resistors: the variance between two nodes is the resistance between them.
void resistances(VectorReport report) {
  using Graph = LandmarkGraph<ScalarUncertainty, 13>;
  const ScalarPose unit = on_a_line(0.0, 1.0);
  Graph cube, bipartite, grid;
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2)
      if ((i & axis) == 0) cube.fuse(i, i | axis, unit);
  for (int i = 0; i < 9; ++i) bipartite.fuse(i / 3, 3 + i % 3, unit);
  for (int i = 0; i < 12; ++i) {
    if (i % 4 < 3) grid.fuse(i, i + 1, unit);
    if (i < 8) grid.fuse(i, i + 4, unit);
  }
  report("cube, across", landmark_position(cube, 8, 0, 7).uncertainty.position_m2, 5.0 / 6.0, 1e-6);
  report("cube, edge", landmark_position(cube, 8, 0, 1).uncertainty.position_m2, 7.0 / 12.0, 1e-6);
  report("K3,3, edge", landmark_position(bipartite, 6, 0, 3).uncertainty.position_m2, 5.0 / 9.0, 1e-6);
  report("K3,3, same side", landmark_position(bipartite, 6, 0, 1).uncertainty.position_m2, 2.0 / 3.0, 1e-6);
  report("grid 3 x 4", landmark_position(grid, 12, 0, 11).uncertainty.position_m2, 1.7536231884057965, 1e-6);
}

/// A room of 4 x 3 m with a niche, as a scan from `at`.
Descriptor room_from(const Displacement& at) {
  constexpr double kWall[9][2] = {{-2, -1.5},  {2, -1.5},   {2, 1.5},  {0.5, 1.5}, {0.5, 2.2},
                                  {-0.6, 2.2}, {-0.6, 1.5}, {-2, 1.5}, {-2, -1.5}};
  Descriptor scan;
  for (int beam = 0; beam < 360; ++beam) {
    double s = 0.0, c = 1.0, nearest = 100.0;
    sine_cosine(at.yaw_rad + beam / 180.0 * kHalfTurn_rad, s, c);
    for (int i = 0; i < 8; ++i) {
      const double ex = kWall[i + 1][0] - kWall[i][0], ey = kWall[i + 1][1] - kWall[i][1];
      const double px = kWall[i][0] - at.x_m, py = kWall[i][1] - at.y_m;
      const double cross = c * ey - s * ex;
      if (cross == 0.0) continue;
      const double range = (px * ey - py * ex) / cross, along = (px * s - py * c) / cross;
      if (range > 0.0 && along >= 0.0 && along <= 1.0 && range < nearest) nearest = range;
    }
    sine_cosine(beam / 180.0 * kHalfTurn_rad, s, c);
    scan.add(nearest * c, nearest * s);
  }
  return scan;
}

/// Four landmarks in a square, seen and measured with a wrong odometry; the loop is closed by a scan match.
void small_map(VectorReport report) {
  static LandmarkMap<20> map;
  const FullPose leg{{1.5, 0.05, kQuarter}, {Matrix3::diagonal(1e-3, 1e-3, 1e-3)}};
  for (int i = 0; i < 4; ++i) map.add(room_from({0.3 * i, 0.0, kQuarter * i}));
  for (int i = 0; i < 3; ++i) map.measure(i, i + 1, leg);
  const DescriptorMatch match =
      match_descriptor(map.descriptor(0), room_from({0.12, -0.07, 0.2}), {{0.0, 0.0, 0.0}, 0.3, 0.4});
  report("match x", match.landmark_from_scan.x_m, 0.12, 0.01);
  report("match y", match.landmark_from_scan.y_m, -0.07, 0.01);
  report("match yaw", match.landmark_from_scan.yaw_rad, 0.2, 0.004);
  report("match quality", match.quality, 1.0, 0.15);
  map.measure(3, 0, leg);
  // Against Gauss-Newton with numerical derivatives (numpy).
  report("square, far corner x", map.landmark(2).pose.x_m, 1.45, 1e-7);
  report("square, far corner y", map.landmark(2).pose.y_m, 1.55, 1e-7);
  report("square, far corner U x", map.landmark(2).uncertainty.covariance(0, 0), 0.00194675, 1e-8);
  report("square, last corner U yaw", map.landmark(3).uncertainty.covariance(2, 2), 0.00056987, 1e-8);
}

}  // namespace

void landmark_vectors(VectorReport report) {
  algebra(report);
  delta_star(report);
  resistances(report);
  small_map(report);
}

}  // namespace madori::test
