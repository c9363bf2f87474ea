// The mountings of the lidars: found by a short drive, and told where they are not as typed.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>

#include "app/mounting/mounting_findings.hpp"
#include "app/mounting/mounting_manoeuvre.hpp"
#include "app/mounting/mounting_words.hpp"
#include "core/angle.hpp"
#include "tests/support/mounting_trial.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

namespace madori::app {
namespace {

using localization::MountingKnown;
using localization::MountingLack;

void expect_found(const localization::FoundMounting& found, const mapping::SensorRecord& truth) {
  ASSERT_EQ(found.known, MountingKnown::All) << truth.type;
  EXPECT_LT(std::hypot(found.mounting.x_m - truth.x_m, found.mounting.y_m - truth.y_m), 0.01) << truth.type;
  EXPECT_LT(std::abs(wrap_angle(found.mounting.yaw_rad - to_rad(truth.yaw_deg))), to_rad(0.3)) << truth.type;
  EXPECT_LT(found.residual_m, 0.02);
  EXPECT_EQ(found.lack, MountingLack::Nothing);
}

class EachKind : public testing::TestWithParam<const char*> {};

TEST_P(EachKind, IsFoundByAShortDriveWithSlipAndUnequalWheels) {
  const auto trial = test::random_mounting(GetParam(), 2001);
  const auto result = test::run_mounting_trial(trial);
  EXPECT_TRUE(result.driven) << result.stopped;
  EXPECT_EQ(result.contacts, 0U);
  const auto& found = result.found.lidars.front();
  expect_found(found, trial.truth.front());
  const auto findings = mounting_findings(result.found, trial.typed);
  EXPECT_GT(findings.front().apart_m(), 0.03) << "it was typed elsewhere";
  EXPECT_EQ(found.floor.has_value(), GetParam() == std::string("vlp16"));
  if (found.floor) {
    EXPECT_NEAR(findings.front().found.z_m, trial.truth.front().z_m, 0.02);
    EXPECT_LT(findings.front().tilt_deg(), 0.5);
  }
}

INSTANTIATE_TEST_SUITE_P(Mounting, EachKind, testing::Values("vlp16", "lms1xx", "s300"));

TEST(Mounting, OfTwoScannersAtOppositeCornersIsFoundTogetherAndTheyAgree) {
  test::MountingTrial trial;
  trial.seed = 2005;
  trial.truth = {{"front", "lms1xx", 0.72, 0.25, 0.2, 40.0}, {"rear", "s300", -0.15, -0.25, 0.2, -140.0}};
  trial.typed = {{"front", "lms1xx", 0.6, 0.3, 0.2, 45.0}, {"rear", "s300", -0.2, -0.2, 0.2, -135.0}};
  const auto result = test::run_mounting_trial(trial);
  for (std::size_t i = 0; i < 2; ++i) expect_found(result.found.lidars[i], trial.truth[i]);
  ASSERT_EQ(result.found.agreements.size(), 1U);
  EXPECT_LT(result.found.agreements.front().apart_m, 0.03);
  EXPECT_GT(result.found.agreements.front().walls, 10);
}

TEST(Mounting, AnEmergencyStopEndsTheDriveAndNothingGoesOnWhenItIsReleased) {
  auto trial = test::random_mounting("lms1xx", 1);
  trial.pressed_at_s = 5.0;
  const auto result = test::run_mounting_trial(trial);
  EXPECT_FALSE(result.driven);
  EXPECT_EQ(result.stopped, notice(kMountingDriveStopped).text);
}

TEST(Mounting, DrivingStraightOnTellsTheYawAloneAndSaysSo) {
  auto trial = test::random_mounting("lms1xx", 2002);
  trial.turn_rad = 0.0;
  const auto result = test::run_mounting_trial(trial);
  EXPECT_TRUE(result.driven) << result.stopped;
  const auto& found = result.found.lidars.front();
  EXPECT_EQ(found.known, MountingKnown::Yaw);
  EXPECT_EQ(found.lack, MountingLack::Turn);
  EXPECT_LT(std::abs(wrap_angle(found.mounting.yaw_rad - to_rad(trial.truth.front().yaw_deg))), to_rad(0.3));
  EXPECT_DOUBLE_EQ(found.mounting.x_m, trial.typed.front().x_m) << "what was not observable is not guessed";
  EXPECT_DOUBLE_EQ(found.mounting.y_m, trial.typed.front().y_m);
  ASSERT_TRUE(result.found.wheels);
  EXPECT_LT(result.found.wheels->sigma.head<2>().maxCoeff(), 0.01);
  EXPECT_GT(result.found.wheels->sigma[2], 0.02) << "how far apart the wheels are was not driven";
  EXPECT_NE(mounting_findings(result.found, trial.typed).front().lack.text.find("must turn"),
            std::string::npos);
}

TEST(Mounting, TurningOnTheSpotAloneTellsNothing) {
  auto trial = test::random_mounting("lms1xx", 2003);
  trial.way_m = 0.0;
  const auto result = test::run_mounting_trial(trial);
  const auto& found = result.found.lidars.front();
  EXPECT_EQ(found.known, MountingKnown::Nothing);
  EXPECT_EQ(found.lack, MountingLack::Straight);
  EXPECT_DOUBLE_EQ(found.mounting.x_m, trial.typed.front().x_m);
}

void exchange_wheels(localization::MountingDrive& drive) {
  for (auto& wheel : drive.wheels) std::swap(wheel.left_rad, wheel.right_rad);
}
void reverse_left_wheel(localization::MountingDrive& drive) {
  for (auto& wheel : drive.wheels) wheel.left_rad = -wheel.left_rad;
}
void reverse_both_wheels(localization::MountingDrive& drive) {
  for (auto& wheel : drive.wheels) wheel.left_rad = -wheel.left_rad, wheel.right_rad = -wheel.right_rad;
}
void hang_upside_down(localization::MountingDrive& drive) {
  for (auto& sweep : drive.sweeps)
    for (auto& p : sweep.points) p.y_m = -p.y_m, p.z_m = -p.z_m;
}

using Wiring = std::pair<const char*, void (*)(localization::MountingDrive&)>;
class WiredWrongly : public testing::TestWithParam<std::tuple<const char*, Wiring>> {};

TEST_P(WiredWrongly, FindsNothingAndSaysThatItDoesNotFitTogether) {
  auto trial = test::random_mounting(std::get<0>(GetParam()), 3002);
  trial.wired_wrongly = std::get<1>(GetParam()).second;
  const auto result = test::run_mounting_trial(trial);
  ASSERT_TRUE(result.driven) << result.stopped;
  const auto& found = result.found.lidars.front();
  EXPECT_EQ(found.known, MountingKnown::Nothing)
      << found.mounting.x_m - trial.truth.front().x_m << " " << found.mounting.y_m - trial.truth.front().y_m;
  EXPECT_EQ(found.lack, MountingLack::Contradiction);
  EXPECT_FALSE(result.found.wheels) << "nor is anything told of the wheels";
  EXPECT_DOUBLE_EQ(found.mounting.x_m, trial.typed.front().x_m);
}

INSTANTIATE_TEST_SUITE_P(
    Mounting, WiredWrongly,
    testing::Combine(testing::Values("lms1xx", "vlp16"),
                     testing::Values(Wiring{"exchanged", exchange_wheels}, Wiring{"left", reverse_left_wheel},
                                     Wiring{"both", reverse_both_wheels}, Wiring{"lidar", hang_upside_down})),
    [](const auto& wiring) {
      return std::string(std::get<0>(wiring.param)) + "_" + std::get<1>(wiring.param).first;
    });

TEST(Mounting, IsNotFoundInACorridorWhereBackLooksLikeForward) {
  for (const std::uint64_t seed : {5002U, 5005U}) {
    auto trial = test::random_mounting("lms1xx", seed);
    trial.corridor = true;
    const auto result = test::run_mounting_trial(trial);
    EXPECT_EQ(result.found.lidars.front().known, MountingKnown::Nothing) << seed;
    EXPECT_EQ(result.found.lidars.front().lack, MountingLack::Walls) << seed;
  }
}

TEST(Mounting, IsFoundWithWheelsOfHalfTheSizeTypedAndThatIsSaid) {
  auto trial = test::random_mounting("lms1xx", 3002);
  trial.wired_wrongly = [](localization::MountingDrive& drive) {
    for (auto& wheel : drive.wheels) wheel.left_rad *= 2.0, wheel.right_rad *= 2.0;
  };
  const auto result = test::run_mounting_trial(trial);
  const auto& found = result.found.lidars.front();
  EXPECT_EQ(found.known, MountingKnown::All);
  EXPECT_EQ(found.lack, MountingLack::Wheels);
  const auto told = mounting_findings(result.found, trial.typed).front().lack;
  EXPECT_EQ(told.code, kLackWheels.code);
  EXPECT_NEAR(std::stod(told.values.at("left")), -50.0, 3.0);
}

TEST(WrongMounting, AHeightWrongByThirtyCentimetresIsToldBeforeTheFirstOrderWhichDoesNotStart) {
  auto v = test::corridor_vehicle();
  const double typed_m = v->config.lidars.front().mounting.z_m;
  v->lidar.height_m = typed_m + 0.3;
  v->say(OperatorWord::Resume);
  const auto told = [&] { return v->state().standstill.cause.code == "lidar-height"; };
  ASSERT_TRUE(v->run_until(told, 5.0)) << v->state().standstill.cause.text;
  char words[120];
  std::snprintf(words, sizeof words, "hangs %.2f m above the floor that it sees, and %.2f m was typed",
                typed_m + 0.3, typed_m);
  EXPECT_NE(v->state().standstill.cause.text.find(words), std::string::npos)
      << v->state().standstill.cause.text;
  EXPECT_EQ(v->state().standstill.remedy, notice(Remedy::CorrectMounting));
  v->drive_to({{2}});
  EXPECT_FALSE(v->run_until([&] { return std::abs(v->rolling.speed().linear_mps) > 0.01; }, 10.0));
  EXPECT_TRUE(told()) << v->state().standstill.cause.text;
  v->say(OperatorWord::ManualOn);
  for (int i = 0; i < 50; ++i) {
    v->commands.push_back({OperatorWord::Jog, {0.2, 0.0}});
    v->step();
  }
  EXPECT_GT(v->rolling.speed().linear_mps, 0.1) << "a person may drive it by hand";
}

TEST(WrongMounting, ARightHeightIsNoDoubt) {
  auto v = test::corridor_vehicle();
  v->run_until([] { return false; }, 3.0);
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
  EXPECT_FALSE(v->state().mounting.doubt());
  EXPECT_GE(v->state().mounting.floors[0].count, MountingWatch::kLooks) << "it looked";
}

/// The place as a lidar tells it that really looks `wrong_rad` further left than typed: the heading is wrong
/// by as much, the way is not.
class TurnedPose : public test::TruePose {
 public:
  TurnedPose(const test::RollingVehicle& vehicle, double wrong_rad)
      : TruePose(vehicle), wrong_rad_(wrong_rad) {}
  PoseEstimate on_odometry(const OdometryReading& reading) override {
    PoseEstimate pose = TruePose::on_odometry(reading);
    const auto& p = pose.map_from_base;
    pose.map_from_base = {p.x_m(), p.y_m(), p.yaw_rad() + wrong_rad_};
    return pose;
  }

 private:
  double wrong_rad_;
};

std::vector<std::string> yaw_events(double wrong_rad, std::string& cause) {
  auto routes = planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,30,0\n").graph;
  test::ToyVehicle v(test::toy_config(std::move(routes)), {0.0, 0.0, 0.0});
  v.config.lidars.front().mounting.yaw_rad = to_rad(10.0);
  v.set_source(std::make_unique<TurnedPose>(v.rolling, wrong_rad));
  std::vector<std::string> said;
  v.on_step = [&](const CycleInput&, const CycleOutput& out, const CycleState&) {
    for (const auto& event : out.events)
      if (event.find("was typed") != std::string::npos) said.push_back(event);
  };
  v.drive_to({{1}});
  v.say(OperatorWord::ManualOn);
  for (int i = 0; i < 1500; ++i) {
    v.commands.push_back({OperatorWord::Jog, {0.4, 0.0}});
    v.step();
  }
  v.say(OperatorWord::ManualOff);
  v.say(OperatorWord::Resume);
  v.run_until([] { return false; }, 2.0);
  cause = v.state().standstill.cause.code;
  return said;
}

TEST(WrongMounting, AYawWrongBySomeDegreesIsToldAfterTheFirstMetresAndStopsWhereItIsDangerous) {
  std::string cause;
  const auto slightly = yaw_events(to_rad(3.5), cause);
  ASSERT_EQ(slightly.size(), 1U);
  EXPECT_NE(slightly.front().find("would look at 13.50 degrees, and 10.00 was typed"), std::string::npos)
      << slightly.front();
  EXPECT_NE(cause, "lidar-yaw") << "3.5 degrees are told, and driven with";
  EXPECT_FALSE(yaw_events(to_rad(-8.0), cause).empty());
  EXPECT_EQ(cause, "lidar-yaw");
  EXPECT_TRUE(yaw_events(to_rad(0.3), cause).empty());
  for (const double far_deg : {30.0, 45.0, -90.0, 180.0}) {
    EXPECT_FALSE(yaw_events(to_rad(far_deg), cause).empty()) << far_deg;
    EXPECT_EQ(cause, "lidar-yaw") << far_deg;
  }
}

TEST(Mounting, SweepsOfAnotherTimeDoNotLetTheVehicleDrive) {
  for (const double age_s : {0.0, 1.0}) {
    MountingManoeuvre manoeuvre(test::toy_config({}));
    control::wire::Status running;
    running.state = control::wire::DriveState::Running;
    CycleOutput output;
    for (int i = 0; i < 75; ++i) {
      CycleInput input;
      input.now = stamp_from_seconds(1'000.0 + 0.02 * i);
      running.time_us = static_cast<std::uint32_t>(20'000 * i);
      input.drive.push_back(running);
      if (i % 5 == 0) input.clouds.push_back({input.now - duration_from_seconds(age_s), {}});
      output = manoeuvre.step(input, {});
    }
    EXPECT_EQ(output.command.linear_mps > 0.0, age_s == 0.0) << manoeuvre.notice().text;
    EXPECT_EQ(manoeuvre.notice().code, age_s == 0.0 ? "" : kMountingLidarSilent.code);
  }
}

}  // namespace
}  // namespace madori::app
