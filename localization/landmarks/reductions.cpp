#include "localization/landmarks/reductions.hpp"

namespace madori::localization::landmarks {
namespace {

double share(double variance, double sum) {
  return sum > 0.0 ? variance / sum : 0.0;
}

/// The three sides of a triangle as variances, and the arms of its star.
struct Sides {
  double ab, bc, ac;
  [[nodiscard]] double sum() const { return ab + bc + ac; }
  [[nodiscard]] double arm_a() const { return ac * share(ab, sum()); }
  [[nodiscard]] double arm_b() const { return ab * share(bc, sum()); }
  [[nodiscard]] double arm_c() const { return ac * share(bc, sum()); }
};

}  // namespace

StarArms star_of_delta(const ScalarPose& ab, const ScalarPose& bc, const ScalarPose& ac) {
  const Sides d{ab.uncertainty.position_m2, bc.uncertainty.position_m2, ac.uncertainty.position_m2};
  const Sides yaw{ab.uncertainty.yaw_rad2, bc.uncertainty.yaw_rad2, ac.uncertainty.yaw_rad2};
  const double open_yaw = wrapped(ab.motion.yaw_rad + bc.motion.yaw_rad - ac.motion.yaw_rad);
  Displacement b = ab.motion;
  b.yaw_rad -= open_yaw * share(yaw.ab, yaw.sum());
  const double bc_yaw = bc.motion.yaw_rad - open_yaw * share(yaw.bc, yaw.sum());
  double bc_x = bc.motion.x_m, bc_y = bc.motion.y_m;
  turn(b.yaw_rad, bc_x, bc_y);
  const double open_x = b.x_m + bc_x - ac.motion.x_m;
  const double open_y = b.y_m + bc_y - ac.motion.y_m;
  b.x_m -= open_x * share(d.ab, d.sum());
  b.y_m -= open_y * share(d.ab, d.sum());
  const Displacement c{ac.motion.x_m + open_x * share(d.ac, d.sum()),
                       ac.motion.y_m + open_y * share(d.ac, d.sum()), b.yaw_rad + bc_yaw};
  const Displacement middle{(b.x_m + c.x_m) / 3.0, (b.y_m + c.y_m) / 3.0, (b.yaw_rad + c.yaw_rad) / 3.0};
  return {{middle, {d.arm_a(), yaw.arm_a()}},
          {b.inverse() * middle, {d.arm_b(), yaw.arm_b()}},
          {c.inverse() * middle, {d.arm_c(), yaw.arm_c()}}};
}

}  // namespace madori::localization::landmarks
