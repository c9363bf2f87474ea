// The worked example of docs/how-to/add-a-safety-rule.md: what stands between the marks is on that page, word
// for word.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/cycle/safety_rules.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

namespace madori::app {
namespace {

// example: begin
/// Brakes that hold by current are weak at the end of a battery.
bool battery_is_low(const CycleState& state, const CycleInput& /*input*/, const CycleConfig& /*config*/) {
  constexpr int kLowestMv = 22'000;  // a 24 V lead battery at rest, nearly empty
  return state.drive_heard && state.drive.battery_mv < kLowestMv;
}

const SafetyRule kBatteryRule{{"battery-low", "the battery is nearly empty"},
                              {"charge", "push the vehicle to its charger"},
                              false,
                              battery_is_low};
// example: end

TEST(SafetyRule, AMadeUpOneStopsTheVehicleSaysWhyAndLetsItGoOn) {
  auto v = test::corridor_vehicle();
  v->config.safety_rules.push_back(kBatteryRule);
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  v->battery_mv = 21'500;
  v->run_until([&] { return false; }, 2.5);
  EXPECT_EQ(v->output.command, VelocityCommand{});
  EXPECT_EQ(v->state().mode, Mode::Waiting);
  EXPECT_EQ(v->state().standstill.cause.text, "the battery is nearly empty");
  v->battery_mv = 25'000;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << "it is exchanged, and goes on by itself";
}

TEST(SafetyRule, OneThatDoesNotHoldByHandLetsAPersonDrive) {
  auto v = test::corridor_vehicle();
  v->config.safety_rules.push_back(kBatteryRule);
  v->battery_mv = 21'500;
  v->say(OperatorWord::ManualOn);
  const auto drives_by_hand = [&] {
    for (int i = 0; i < 50; ++i) {
      v->commands.push_back({OperatorWord::Jog, {0.2, 0.0}});
      v->step();
    }
    return v->output.command.linear_mps > 0.1;
  };
  EXPECT_TRUE(drives_by_hand());
  v->config.safety_rules.back().by_hand = true;
  EXPECT_FALSE(drives_by_hand());
}

TEST(SafetyRule, ThePageShowsTheExampleThatRunsHere) {
  const auto text_of = [](const char* path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  };
  const std::string here = text_of(MADORI_SOURCE_DIR "/tests/unit/app/safety_rule_example_test.cpp");
  const std::string begin = "// example: begin\n";
  const auto from = here.find(begin) + begin.size();
  std::istringstream example(here.substr(from, here.find("// example: end") - from));
  std::string indented;
  for (std::string line; std::getline(example, line);) indented += (line.empty() ? "" : "    " + line) + "\n";
  EXPECT_GT(indented.size(), 300U);
  EXPECT_NE(text_of(MADORI_SOURCE_DIR "/docs/how-to/add-a-safety-rule.md").find(indented), std::string::npos);
}

}  // namespace
}  // namespace madori::app
