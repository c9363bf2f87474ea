#include "app/cycle/modes.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "app/cycle/notice.hpp"
#include "app/panel/event_words.hpp"

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

TEST(EventWords, EveryStandstillOfTheLogComesBackWithItsRemedy) {
  for (std::size_t c = 0; c < kCauses.size(); ++c) {
    for (std::size_t r = 0; r < kRemedies.size(); ++r) {
      const std::map<std::string, std::string> values{{"reason", "two places - look alike"},
                                                      {"node", "7"},
                                                      {"faults", "4"},
                                                      {"percent", "64"},
                                                      {"metres", "0.9"},
                                                      {"degrees", "90"},
                                                      {"name", "top"},
                                                      {"found", "1.2"},
                                                      {"typed", "0.9"},
                                                      {"turned", "0.1"},
                                                      {"asked", "0.5"},
                                                      {"order", "3"}};
      const Notice cause = notice(static_cast<Cause>(c), values);
      const Notice remedy = notice(static_cast<Remedy>(r), values);
      const auto view = event_view({{}, "mode", "waiting: " + cause.text + " - " + remedy.text});
      EXPECT_EQ(view.what.code, cause.code);
      EXPECT_EQ(view.what.text, cause.text);
      EXPECT_EQ(cause.text.find('{'), std::string::npos) << "no value for a placeholder: " << cause.text;
      for (const auto& [name, value] : view.what.values) {  // shown() adds some of its own
        if (values.contains(name)) {
          EXPECT_EQ(value, values.at(name));
        }
      }
      EXPECT_EQ(view.what.values.empty(),
                std::string_view(kCauses[c].english).find('{') == std::string_view::npos);
      EXPECT_EQ(view.remedy.code, remedy.code) << view.remedy.text;
    }
  }
}

TEST(EventWords, OrdersAndModesHaveCodesAndWhatIsNotKnownStays) {
  EXPECT_EQ(event_view({{}, "mode", "driving -> waiting: blocked"}).what.code, "event.mode-waiting");
  const auto done = event_view({{}, "order", "order 12: stop reached; done"});
  EXPECT_EQ(done.what.code, "event.order-done");
  EXPECT_EQ(done.what.values.at("order"), "12");
  EXPECT_EQ(event_view({{}, "order", "order 12: stop reached; running"}).what.code, "event.order-reached");
  EXPECT_EQ(event_view({{}, "order", "order 3 refused: no way"}).what.values.at("reason"), "no way");
  EXPECT_EQ(event_view({{}, "mode", "fault: the drive reports fault 4 - confirm"}).severity, "stop");
  EXPECT_EQ(event_view({{}, "mode", "paused: paused - press Resume"}).severity, "info");
  EXPECT_EQ(event_view({{}, "mode", "something: else"}).what.code, "");
  EXPECT_EQ(event_view({{}, "mode", "something: else"}).what.text, "something: else");
}

}  // namespace
}  // namespace madori::app
