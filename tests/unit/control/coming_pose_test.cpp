#include "control/prediction/coming_pose.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace madori::control {
namespace {

constexpr double kCommandEveryS = 0.02;

/// A vehicle whose wheels obey a dead time late, as they are told but no faster than they can.
struct LateVehicle {
  WheelResponse response;
  Transform2<Map, Base> pose;
  VelocityCommand v;
  std::deque<VelocityCommand> unheard;

  void step(const VelocityCommand& told) {
    unheard.push_back(told);
    VelocityCommand wanted = v;
    if (static_cast<double>(unheard.size()) * kCommandEveryS > response.reaction_s + 1e-9) {
      wanted = unheard.front();
      unheard.pop_front();
    }
    const auto to = [](double now, double wish, double most) {
      return now + std::clamp(wish - now, -most, most);
    };
    v = {to(v.linear_mps, wanted.linear_mps, response.change_mps2 * kCommandEveryS),
         to(v.angular_radps, wanted.angular_radps, response.turn_change_radps2 * kCommandEveryS)};
    const double half = 0.5 * v.angular_radps * kCommandEveryS, way = v.linear_mps * kCommandEveryS;
    pose = pose * Transform2<Base, Base>(way * std::cos(half), way * std::sin(half), 2.0 * half);
  }
};

Stamp at_step(int i) {
  return stamp_from_seconds(50.0) + i * std::chrono::milliseconds(20);
}

TEST(ComingPose, IsWhereTheVehicleIsOneReactionLater) {
  for (const double reaction_s : {0.0, 0.1, 0.4}) {
    LateVehicle vehicle;
    vehicle.response.reaction_s = reaction_s;
    SentCommands sent;
    const int late = static_cast<int>(std::lround(reaction_s / kCommandEveryS));
    std::vector<Transform2<Map, Base>> foreseen;
    double worst_m = 0.0;
    for (int i = 0; i < 400; ++i) {
      // speeds up, curves, stands suddenly, and goes back
      const VelocityCommand told = i < 100   ? VelocityCommand{std::min(1.0, 0.01 * i), 0.0}
                                   : i < 200 ? VelocityCommand{1.0, 0.5}
                                   : i < 300 ? VelocityCommand{}
                                             : VelocityCommand{-0.3, 0.2};
      foreseen.push_back(vehicle.pose *
                         sent.way_until_obeyed(at_step(i), vehicle.v, at_step(i), vehicle.response));
      if (i >= 2 * late + 2)
        worst_m = std::max(worst_m, distance_m(foreseen[static_cast<std::size_t>(i - late)].translation(),
                                               vehicle.pose.translation()));
      sent.add(at_step(i), told, vehicle.response);
      vehicle.step(told);
    }
    EXPECT_LT(worst_m, 0.005) << reaction_s;
  }
}

TEST(ComingPose, NothingSentIsNoWay) {
  const SentCommands none;
  const auto way = none.way_until_obeyed(at_step(0), {1.0, 0.0}, at_step(1), {});
  EXPECT_EQ(way.x_m(), 0.0);
  EXPECT_EQ(way.yaw_rad(), 0.0);
}

TEST(ComingPose, ADriveThatWasNeverHeardIsNotFollowedSinceTheEpoch) {
  SentCommands sent;
  sent.add(at_step(0), {}, {});
  EXPECT_EQ(sent.way_until_obeyed(Stamp{}, {}, at_step(1), {}).x_m(), 0.0);
}

TEST(ComingPose, RemembersNoMoreThanMatters) {
  SentCommands sent;
  for (int i = 0; i < 10'000; ++i) sent.add(at_step(i), {0.1, 0.0}, {});
  EXPECT_LT(sent.sent().size(), 45U);
}

}  // namespace
}  // namespace madori::control
