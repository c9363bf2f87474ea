#include "app/cycle/modes.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace madori::app {
namespace {

/// Table rows below the heading "## Transitions" of docs/reference/states.md.
std::set<std::string> documented() {
  std::ifstream page(MADORI_SOURCE_DIR "/docs/reference/states.md");
  std::set<std::string> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) inside = line == "## Transitions";
    if (inside && line.starts_with("| ") && !line.starts_with("| mode") && !line.starts_with("| ---"))
      rows.insert(line);
  }
  return rows;
}

TEST(Modes, ThePageAndTheCodeAgree) {
  std::set<std::string> coded;
  for (const Mode mode : kModes)
    for (const ModeEvent event : kModeEvents)
      if (const auto next = next_mode(mode, event))
        coded.insert(std::string("| ") + to_string(mode) + " | " + to_string(event) + " | " +
                     to_string(*next) + " |");
  EXPECT_EQ(coded, documented());
  EXPECT_GT(coded.size(), 40U);
}

TEST(Modes, NothingButTheOperatorEndsAHeldMode) {
  const std::set<ModeEvent> operators{ModeEvent::Resume, ModeEvent::Pause, ModeEvent::ManualOn,
                                      ModeEvent::ManualOff, ModeEvent::Confirmed};
  for (const Mode mode : kModes) {
    if (!is_held(mode)) continue;
    for (const ModeEvent event : kModeEvents) {
      const auto next = next_mode(mode, event);
      if (next && !is_held(*next)) {
        EXPECT_TRUE(operators.contains(event)) << to_string(mode) << ' ' << to_string(event);
      }
    }
  }
}

TEST(Modes, AnEmergencyLeadsAlwaysToItsModeAndOnlyConfirmationLeaves) {
  for (const Mode mode : kModes)
    if (mode != Mode::EmergencyStop) {
      EXPECT_EQ(next_mode(mode, ModeEvent::EmergencyOn), Mode::EmergencyStop);
    }
  for (const ModeEvent event : kModeEvents)
    if (event != ModeEvent::Confirmed) {
      EXPECT_EQ(next_mode(Mode::EmergencyStop, event), std::nullopt) << to_string(event);
    }
  EXPECT_EQ(next_mode(Mode::EmergencyStop, ModeEvent::Confirmed), Mode::Paused);
}

TEST(Modes, EveryModeCanBeReachedFromTheFirst) {
  std::set<Mode> reached{Mode::Paused};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const Mode mode : std::set<Mode>(reached))
      for (const ModeEvent event : kModeEvents)
        if (const auto next = next_mode(mode, event)) reached.insert(*next);
  }
  EXPECT_EQ(reached.size(), kModes.size());
}

}  // namespace
}  // namespace madori::app
