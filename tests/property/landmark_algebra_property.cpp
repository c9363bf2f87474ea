// The laws of the landmark algebra for random poses and uncertainties.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/angle.hpp"
#include "localization/landmarks/bare_math.hpp"
#include "localization/landmarks/elimination.hpp"
#include "localization/landmarks/reductions.hpp"

namespace madori::localization::landmarks {
namespace {

double number(double most) {
  return *rc::gen::inRange(-1000000, 1000001) * 1e-6 * most;
}
double positive(double most) {
  return *rc::gen::inRange(1, 1000001) * 1e-6 * most;
}
Displacement displacement() {
  return {number(10.0), number(10.0), number(3.1)};
}

ScalarPose any(ScalarPose*) {
  return {displacement(), {positive(0.1), positive(0.1)}};
}
FullPose any(FullPose*) {
  Matrix3 root = Matrix3::diagonal(positive(0.3) + 0.05, positive(0.3) + 0.05, positive(0.1) + 0.05);
  root(1, 0) = number(0.05), root(2, 0) = number(0.05), root(2, 1) = number(0.05);
  return {displacement(), {root * transposed(root)}};
}
template <class Pose>
Pose any() {
  return any(static_cast<Pose*>(nullptr));
}

void expect_close(double a, double b, double tolerance = 1e-9) {
  RC_ASSERT(std::abs(a - b) <= tolerance * (1.0 + std::abs(a)));
}
void expect_same(const Displacement& a, const Displacement& b) {
  expect_close(a.x_m, b.x_m);
  expect_close(a.y_m, b.y_m);
  RC_ASSERT(std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)) < 1e-9);
}
void expect_same(const ScalarPose& a, const ScalarPose& b) {
  expect_same(a.motion, b.motion);
  expect_close(a.uncertainty.position_m2, b.uncertainty.position_m2);
  expect_close(a.uncertainty.yaw_rad2, b.uncertainty.yaw_rad2);
}
void expect_same(const FullPose& a, const FullPose& b) {
  expect_same(a.motion, b.motion);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      expect_close(a.uncertainty.covariance(i, j), b.uncertainty.covariance(i, j), 1e-8);
}

template <class Pose>
void laws() {
  const auto a = any<Pose>(), b = any<Pose>(), c = any<Pose>();
  const Pose nothing{};
  const Pose unknown{displacement(), decltype(a.uncertainty)::unknown()};
  expect_same(added(added(a, b), c), added(a, added(b, c)));
  expect_same(added(a, nothing), a);
  expect_same(added(nothing, a), a);
  expect_same(negated(negated(a)), a);
  expect_same(negated(added(a, b)), added(negated(b), negated(a)));
  expect_same(added(a, negated(a)).motion, nothing.motion);
  expect_same(fused(a, unknown), a);
  expect_same(fused(unknown, a), a);
  RC_ASSERT(added(a, unknown).uncertainty.is_unknown());
}
RC_GTEST_PROP(LandmarkAlgebra, LawsOfThePublishedForm, ()) {
  laws<ScalarPose>();
}
RC_GTEST_PROP(LandmarkAlgebra, LawsOfTheFullForm, ()) {
  laws<FullPose>();
}

/// Measurements of one displacement lie near each other: means of angles all around the circle depend on the
/// order.
template <class Pose>
Pose beside(const Pose& a) {
  auto b = any<Pose>();
  b.motion = {a.motion.x_m + number(0.005), a.motion.y_m + number(0.005),
              wrap_angle(a.motion.yaw_rad + number(0.5))};
  return b;
}
template <class Pose>
void fusion_laws() {
  const auto a = any<Pose>();
  const auto b = beside(a), c = beside(a);
  expect_same(fused(a, b), fused(b, a));
  expect_same(fused(fused(a, b), c), fused(a, fused(b, c)));
}
RC_GTEST_PROP(LandmarkAlgebra, FusionOfThePublishedForm, ()) {
  fusion_laws<ScalarPose>();
}
RC_GTEST_PROP(LandmarkAlgebra, FusionOfTheFullForm, ()) {
  fusion_laws<FullPose>();
}

/// The full form's first-order covariances against finite differences of the motion itself.
RC_GTEST_PROP(LandmarkAlgebra, TheLeverArmIsRight, ()) {
  const auto a = any<FullPose>(), b = any<FullPose>();
  const auto jacobian = [&](const auto& of, const Displacement& at) {
    Matrix3 j;
    for (int k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-6;
      Displacement up = at, down = at;
      (k == 0 ? up.x_m : k == 1 ? up.y_m : up.yaw_rad) += kStep;
      (k == 0 ? down.x_m : k == 1 ? down.y_m : down.yaw_rad) -= kStep;
      const Displacement p = of(up), q = of(down);
      j(0, k) = (p.x_m - q.x_m) / (2.0 * kStep);
      j(1, k) = (p.y_m - q.y_m) / (2.0 * kStep);
      j(2, k) = wrap_angle(p.yaw_rad - q.yaw_rad) / (2.0 * kStep);
    }
    return j;
  };
  const Matrix3 by_a = jacobian([&](const Displacement& d) { return d * b.motion; }, a.motion);
  const Matrix3 by_b = jacobian([&](const Displacement& d) { return a.motion * d; }, b.motion);
  const Matrix3 back = jacobian([](const Displacement& d) { return d.inverse(); }, a.motion);
  const Matrix3 sum = carried(by_a, a.uncertainty.covariance) + carried(by_b, b.uncertainty.covariance);
  const Matrix3 turned_back = carried(back, a.uncertainty.covariance);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      expect_close(added(a, b).uncertainty.covariance(i, j), sum(i, j), 1e-6);
      expect_close(negated(a).uncertainty.covariance(i, j), turned_back(i, j), 1e-6);
    }
}

/// Between every two corners the star says what the triangle says: series beside the direct side, mean and
/// variance; the orientations of its middle agree from all corners.
RC_GTEST_PROP(LandmarkAlgebra, DeltaStarKeepsAllPairs, ()) {
  auto ab = any<ScalarPose>(), bc = any<ScalarPose>();
  auto ac = added(ab, bc);
  ac.uncertainty = any<ScalarPose>().uncertainty;
  ac.motion.x_m += number(0.5), ac.motion.y_m += number(0.5);
  const StarArms star = star_of_delta(ab, bc, ac);
  expect_same(added(star.from_a, negated(star.from_b)), fused(ab, added(ac, negated(bc))));
  expect_same(added(star.from_a, negated(star.from_c)), fused(ac, added(ab, bc)));
  ScalarPose b_to_c = fused(bc, added(negated(ab), ac));
  expect_same(added(star.from_b, negated(star.from_c)), b_to_c);
}
/// With an open angle too; the positions then depend on the corner that they are closed from.
RC_GTEST_PROP(LandmarkAlgebra, DeltaStarSharesAnOpenAngleByVariance, ()) {
  auto ab = any<ScalarPose>(), bc = any<ScalarPose>();
  auto ac = added(ab, bc);
  ac.uncertainty = any<ScalarPose>().uncertainty;
  ac.motion.yaw_rad = wrap_angle(ac.motion.yaw_rad + number(0.5));
  const StarArms star = star_of_delta(ab, bc, ac);
  const double a_to_b = star.from_a.motion.yaw_rad - star.from_b.motion.yaw_rad;
  const double a_to_c = star.from_a.motion.yaw_rad - star.from_c.motion.yaw_rad;
  expect_close(wrap_angle(a_to_b - fused(ab, added(ac, negated(bc))).motion.yaw_rad), 0.0);
  expect_close(wrap_angle(a_to_c - fused(ac, added(ab, bc)).motion.yaw_rad), 0.0);
}

/// Why there is no delta-star with full covariances: the conductance that a star of three arms leaves between
/// two of its ends is not symmetric, so it is no inverse covariance.
TEST(LandmarkAlgebra, AStarOfFullCovariancesLeavesNoEdges) {
  const Matrix3 a = Matrix3::diagonal(1.0, 4.0, 1.0);
  const Matrix3 b{{{2.0, 1.0, 0.0}, {1.0, 2.0, 0.0}, {0.0, 0.0, 1.0}}};
  const Matrix3 c = Matrix3::diagonal(5.0, 1.0, 1.0);
  const Matrix3 between = a * inverse(a + b + c) * b;
  EXPECT_GT(std::abs(between(0, 1) - between(1, 0)), 0.1);
  const Matrix3 series = a * inverse(a + b) * b;
  EXPECT_NEAR(series(0, 1), series(1, 0), 1e-12);
}

RC_GTEST_PROP(BareMath, AgreesWithTheLibrary, ()) {
  const double x = number(1000.0), y = number(1000.0);
  double s = 0.0, c = 0.0;
  sine_cosine(x, s, c);
  RC_ASSERT(std::abs(s - std::sin(x)) < 1e-12 && std::abs(c - std::cos(x)) < 1e-12);
  RC_ASSERT(std::abs(arctangent(y, x) - std::atan2(y, x)) < 1e-14);
  RC_ASSERT(std::abs(square_root(std::abs(x)) - std::sqrt(std::abs(x))) < 1e-13);
  const double power = -std::abs(y) / 10.0;
  RC_ASSERT(std::abs(exponential(power) - std::exp(power)) < 1e-14);
  RC_ASSERT(whole_below(x) == static_cast<int>(std::floor(x)));
  RC_ASSERT(std::abs(wrapped(x) - wrap_angle(x)) < 1e-12);
}

}  // namespace
}  // namespace madori::localization::landmarks
