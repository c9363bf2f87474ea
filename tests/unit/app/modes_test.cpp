#include "app/cycle/modes.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "app/cycle/notice.hpp"

namespace madori::app {
namespace {

/// Table rows below a heading of docs/reference/states.md.
std::set<std::string> documented(const std::string& heading) {
  std::ifstream page(MADORI_SOURCE_DIR "/docs/reference/states.md");
  std::set<std::string> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("##")) inside = line == heading;
    const bool is_head =
        line.starts_with("| mode") || line.starts_with("| code") || line.starts_with("| ---");
    if (inside && line.starts_with("| ") && !is_head) rows.insert(line);
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
  EXPECT_EQ(coded, documented("## Transitions"));
  EXPECT_GT(coded.size(), 40U);
}

/// The catalogue as rows of a table; every code once, every {placeholder} closed.
template <class Entries>
std::set<std::string> rows_of(const Entries& entries) {
  std::set<std::string> rows;
  std::set<std::string> codes;
  for (const CatalogueEntry& entry : entries) {
    EXPECT_TRUE(codes.insert(entry.code).second) << entry.code;
    rows.insert(std::string("| ") + entry.code + " | " + entry.english + " |");
  }
  return rows;
}

TEST(Notices, ThePageAndTheCodeAgree) {
  EXPECT_EQ(rows_of(kCauses), documented("### Causes"));
  EXPECT_EQ(rows_of(kRemedies), documented("### Remedies"));
}

TEST(Notices, EnglishIsTheEntryWithItsValues) {
  EXPECT_EQ(notice(Cause::NoWay, {{"node", "7"}}),
            (Notice{"no-way", {{"node", "7"}}, "no way leads to node 7"}));
  EXPECT_EQ(notice(Remedy::ClearWay, {{"reason", "{reason} stands"}}).text, "clear the way: {reason} stands");
  EXPECT_TRUE(Notice().empty());
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
