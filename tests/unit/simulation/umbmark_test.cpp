// UMBmark (Borenstein and Feng 1996), here with sides of 25 m, 100 m around, driven both ways by dead
// reckoning with wheels that are not as large as believed, against the closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/small_hall.hpp"

namespace madori::simulation {
namespace {

constexpr double kSideM = 25.0;

/// Drives by what the encoders say, in ideal steps: `length_m` straight on, then `turn_rad` on the spot.
/// Gentle, so that both wheels keep in step.
class DeadReckoner {
 public:
  explicit DeadReckoner(Factory& factory) : factory_(factory) {}

  void straight(double length_m) {
    turn_wheels(length_m / believed_.left_radius_m, length_m / believed_.right_radius_m);
  }
  void turn(double turn_rad) {
    const double wheel_rad = turn_rad * believed_.half_separation_m / believed_.left_radius_m;
    turn_wheels(-wheel_rad, wheel_rad);
  }

 private:
  void turn_wheels(double left_rad, double right_rad) {
    left_ += left_rad, right_ += right_rad;
    double cruise = 0.0;
    for (int quiet = 0; quiet < 20;) {
      const VehicleState& s = factory_.vehicle_state();
      const double left_error = left_ - s.left_rad, right_error = right_ - s.right_rad;
      cruise = std::min(cruise + 0.04, 8.0);  // 0.8 m/s2, less than any limit of the vehicle
      const auto speed = [&](double error) { return std::clamp(2.0 * error, -cruise, cruise); };
      factory_.step(std::chrono::milliseconds(5), {speed(left_error), speed(right_error)});
      quiet = std::abs(left_error) + std::abs(right_error) < 1e-5 ? quiet + 1 : 0;
    }
  }

  Factory& factory_;
  WheelGeometry believed_;
  double left_ = 0.0, right_ = 0.0;
};

FactorySetup field(double left_percent, double right_percent, double separation_percent) {
  FactorySetup setup = test::small_hall(200.0, 200.0, 100.0, 100.0);
  setup.sensors = {{"front", "lms1xx", 0.8, 0.0, 0.3, 0.0}};  // cheap
  setup.scenario.vehicle.left_radius_error_percent = left_percent;
  setup.scenario.vehicle.right_radius_error_percent = right_percent;
  setup.scenario.vehicle.separation_error_percent = separation_percent;
  return setup;
}

/// The closed form: each leg is an arc, each turn on the spot turns by ratio and shifts by the difference
/// of the radii; the same group of motions, composed exactly.
Transform2<Map, Base> closed_form(const WheelGeometry& truth, int direction) {
  const WheelGeometry believed;
  Transform2<Map, Base> pose(100.0, 100.0, 0.0);
  const double way = kSideM / believed.left_radius_m;
  const double spot = kPi / 2.0 * believed.half_separation_m / believed.left_radius_m * direction;
  for (int leg = 0; leg < 4; ++leg) pose = pose * arc_step(truth, way, way) * arc_step(truth, -spot, spot);
  return pose;
}

/// Borenstein and Feng's first-order result (their Eq. 4.7 and 4.11 for L = side, counter-clockwise): an
/// error of the wheel diameters bends each leg by beta, so that the end is off by -2 L beta in x and in y;
/// one of the track turns too far or too little at each corner by alpha, which gives -2 L alpha likewise.
struct FirstOrder {
  double x_m, y_m;
};
FirstOrder borenstein(const WheelGeometry& truth) {
  const WheelGeometry believed;
  const double ratio = truth.right_radius_m / truth.left_radius_m;
  const double beta = kSideM * (ratio - 1.0) / (2.0 * believed.half_separation_m);
  const double mean = (truth.left_radius_m + truth.right_radius_m) / 2.0 / believed.left_radius_m;
  const double alpha = kPi / 2.0 * (believed.half_separation_m / truth.half_separation_m * mean - 1.0);
  return {-2.0 * kSideM * alpha - 2.0 * kSideM * beta, 2.0 * kSideM * alpha + 2.0 * kSideM * beta};
}

struct Errors {
  double left_percent, right_percent, separation_percent;
};

class Umbmark : public testing::TestWithParam<Errors> {};

TEST_P(Umbmark, BothWaysEndWhereTheClosedFormSays) {
  const auto [left, right, separation] = GetParam();
  for (const int direction : {1, -1}) {
    Factory factory(field(left, right, separation));
    DeadReckoner driver(factory);
    for (int leg = 0; leg < 4; ++leg) {
      driver.straight(kSideM);
      driver.turn(direction * kPi / 2.0);
    }
    const auto expected = closed_form(factory.vehicle().true_wheels(), direction);
    const auto got = factory.truth().map_from_base;
    // The wheels start and stop together, so that the legs are arcs up to the controller's last 1e-5 rad.
    EXPECT_NEAR(got.x_m(), expected.x_m(), 0.01) << direction;
    EXPECT_NEAR(got.y_m(), expected.y_m(), 0.01) << direction;
    EXPECT_NEAR(wrap_angle(got.yaw_rad() - expected.yaw_rad()), 0.0, 1e-3) << direction;
  }
}

INSTANTIATE_TEST_SUITE_P(KnownErrors, Umbmark,
                         testing::Values(Errors{0.0, 0.0, 0.0}, Errors{0.05, -0.05, 0.0},
                                         Errors{0.3, -0.2, 0.0}, Errors{0.0, 0.0, 0.4},
                                         Errors{0.1, 0.0, -0.3}));

TEST(UmbmarkFormula, TheClosedFormHasBorensteinsFirstOrder) {
  // Small errors, so that the second order stays below a centimetre in 100 m.
  for (const auto& [right_error, separation_error] :
       {std::pair{2e-5, 0.0}, std::pair{0.0, 2e-4}, std::pair{1e-5, -1e-4}}) {
    WheelGeometry truth;
    truth.right_radius_m *= 1.0 + right_error;
    truth.half_separation_m *= 1.0 + separation_error;
    const auto end = closed_form(truth, 1);
    const FirstOrder expected = borenstein(truth);
    EXPECT_NEAR(std::abs(end.x_m() - 100.0), std::abs(expected.x_m), 0.01 + 0.05 * std::abs(expected.x_m));
    EXPECT_NEAR(std::abs(end.y_m() - 100.0), std::abs(expected.y_m), 0.01 + 0.05 * std::abs(expected.y_m));
  }
}

}  // namespace
}  // namespace madori::simulation
