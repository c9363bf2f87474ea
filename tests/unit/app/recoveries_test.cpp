// The table of recoveries, and the page that shows it.
#include "app/cycle/recoveries.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"

namespace madori::app {
namespace {

/// The rows of the tables below a heading, as they stand there.
std::vector<std::string> rows_below(const std::string& heading) {
  std::ifstream page(MADORI_SOURCE_DIR "/docs/explanation/narrow-places.md");
  std::vector<std::string> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) inside = line == heading;
    if (inside && line.starts_with("| ") && !line.starts_with("| ---")) rows.push_back(line);
  }
  return rows;
}

TEST(Recoveries, ThePageAndTheTableAgreeInTheirOrder) {
  std::vector<std::string> coded{"| recovery | due | what is done | as long, as often |"};
  for (const Recovery& r : recoveries())
    coded.push_back(std::string("| ") + r.name + " | " + r.condition + " | " + r.action + " | " + r.limit +
                    " |");
  coded.emplace_back("| asked for | said |");
  for (const Ask& ask : asks())
    coded.push_back(std::string("| ") + ask.remedy.english + " | " + ask.cause.english + " |");
  EXPECT_EQ(coded, rows_below("## When the way is blocked"));
}

TEST(Recoveries, EachRowDoesSomethingAndIsNamedOnce) {
  std::set<std::string> names;
  for (const Recovery& r : recoveries()) {
    EXPECT_TRUE(names.insert(r.name).second) << r.name;
    EXPECT_NE(r.most_mps == nullptr, r.act == nullptr) << r.name;
  }
}

/// What is due for a vehicle that has waited for this long before something.
std::set<std::string> due_after(double blocked_s) {
  CycleConfig config;
  CycleState state(config, nullptr);
  CycleInput input;
  input.now = stamp_from_seconds(1000.0);
  state.mode = Mode::Waiting;
  state.pose.health.state = LocalizationState::Localized;
  state.lidar_heard = input.now;
  state.errand.target = Target{1, 0, 0};
  state.way.plain.points = {{{0.0, 0.0}, 0.0}, {{5.0, 0.0}, 0.0}};
  state.way.path = control::TrackedPath(state.way.plain, {});
  state.ahead.check.free_m = state.ahead.stop_along_m = 0.3;
  state.ahead.check.where = {1.0, 0.0};
  state.block.since = state.trail_at = input.now - duration_from_seconds(blocked_s);
  state.detour.failed = "no way";
  std::set<std::string> due;
  for (const Recovery& r : recoveries())
    if (r.due(state, input, config)) due.insert(r.name);
  return due;
}

TEST(Recoveries, OneAfterTheOtherBecomesDue) {
  using Names = std::set<std::string>;
  EXPECT_EQ(due_after(0.5), Names({"stop"}));
  EXPECT_EQ(due_after(2.0), Names({"stop", "detour"}));
  EXPECT_EQ(due_after(11.0), Names({"stop", "detour", "less margin"}));
  EXPECT_EQ(due_after(13.0), Names({"stop", "detour", "less margin", "back out"}));
  EXPECT_EQ(due_after(26.0), Names({"stop", "detour", "less margin", "back out", "another route"}));
}

}  // namespace
}  // namespace madori::app
