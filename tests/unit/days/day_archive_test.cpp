#include "mapping/days/day_archive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mapping/days/day_file.hpp"
#include "mapping/site/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/days/made_up_day.hpp"

namespace madori::mapping {
namespace {

using Sizes = std::vector<std::pair<CivilDay, std::uintmax_t>>;

Sizes every_day(const std::string& first, int count, std::uintmax_t bytes) {
  Sizes days;
  for (int i = 0; i < count; ++i) days.emplace_back(*civil_day(first) + std::chrono::days(i), bytes);
  return days;
}

std::vector<CivilDay> left_of(const Sizes& days, const DayBounds& bounds = {}) {
  const auto drop = days_to_drop(days, bounds);
  std::vector<CivilDay> left;
  for (const auto& [day, bytes] : days)
    if (std::ranges::find(drop, day) == drop.end()) left.push_back(day);
  return left;
}

TEST(DayArchive, SixtyDaysStayAndOneAWeekOfWhatIsOlder) {
  const Sizes days = every_day("2026-01-05", 130, 1000);  // a Monday
  const auto left = left_of(days);
  EXPECT_EQ(left.size(), 60U + 10U);  // 70 older days: ten weeks
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_TRUE(i >= 10 || std::chrono::weekday(left[i]) == std::chrono::Sunday);
    EXPECT_TRUE(i < 10 || left[i] == days[i + 60].first);
  }
}

/// Day after day, as it goes on: what was thinned stays thinned, and nothing young is lost.
TEST(DayArchive, ThinningEveryDayGivesTheSame) {
  const Sizes days = every_day("2024-01-01", 1000, 15'000);
  Sizes kept;
  for (const auto& day : days) {
    kept.push_back(day);
    const auto left = left_of(kept);
    Sizes next;
    for (const CivilDay d : left) next.emplace_back(d, 15'000);
    kept = next;
  }
  std::vector<CivilDay> by_and_by;
  for (const auto& [day, bytes] : kept) by_and_by.push_back(day);
  EXPECT_EQ(by_and_by, left_of(days));
  EXPECT_EQ(by_and_by.size(), 60U + 104U);
}

/// 100 m x 60 m are 96,000 cells. A byte a cell and some is the most that a PNG takes of them.
TEST(DayArchive, WithTheLivingMapItTakesLessThan20Mb) {
  constexpr std::uintmax_t kLivingMap = 96'000 * 68;  // bytes of a cell in hybrid_map_file.hpp
  std::mt19937 engine(7);
  DayMap worst = test::made_up_day("2026-11-25", {"."});
  worst.resize(400, 240);
  for (auto& value : worst.packed) value = static_cast<std::uint8_t>(engine() % 252);
  const std::uintmax_t bytes = day_png(worst).size();
  EXPECT_GT(bytes, 90'000U);
  const auto left = left_of(every_day("2020-01-01", 2000, bytes));
  EXPECT_LT(left.size() * bytes + kLivingMap, 20'000'000U);
  EXPECT_GT(left.size(), 120U);
  EXPECT_EQ(left.back(), *civil_day("2020-01-01") + std::chrono::days(1999));
}

TEST(DayArchive, ADayWithAWrongClockTakesNoYoungOnesAway) {
  Sizes days = every_day("2026-10-01", 56, 1000);
  days.emplace_back(*civil_day("2099-01-01"), 1000);
  EXPECT_EQ(left_of(days).size(), days.size());
}

TEST(DayArchive, ADayIsWrittenOverUntilItEnds) {
  const test::TemporaryFolder folder;
  keep_day(folder.path(), test::made_up_day("2026-11-24", {"#..."}));
  keep_day(folder.path(), test::made_up_day("2026-11-25", {"#..."}));
  keep_day(folder.path(), test::made_up_day("2026-11-25", {"#.ss"}));
  ASSERT_EQ(kept_days(folder.path()).size(), 2U);
  const auto day = load_day(folder.path(), *civil_day("2026-11-25"));
  ASSERT_TRUE(day.ok());
  EXPECT_EQ(day.value().at(1, 3).state, DayState::SemiStatic);
  EXPECT_FALSE(load_day(folder.path(), *civil_day("2026-11-26")).ok());
}

TEST(DayArchive, DamagedFilesAreSkippedWithAWord) {
  const test::TemporaryFolder folder;
  for (const char* date : {"2026-11-23", "2026-11-24", "2026-11-25"})
    keep_day(folder.path(), test::made_up_day(date, {"#..."}));
  const auto days = folder.path() / kDaysFolder;
  const std::string good = file_content(days / "2026-11-24.png");
  write_file_atomically(days / "2026-11-24.png", good.substr(0, good.size() / 2));
  write_file_atomically(days / "2026-11-22.png", good);  // its name says another day
  write_file_atomically(days / "notes.png", "no day");
  DayMap other = test::made_up_day("2026-11-21", {"#..."});
  other.frame = "ffffffffffffffff";
  keep_day(folder.path(), other);
  const LoadedDays loaded =
      load_days(folder.path(), test::kMadeUpFrame, *civil_day("2026-11-01"), *civil_day("2026-11-25"));
  EXPECT_EQ(loaded.days.size(), 2U);
  EXPECT_EQ(loaded.of_other_frames, 1U);
  ASSERT_EQ(loaded.skipped.size(), 2U);
  EXPECT_NE(loaded.skipped[0].find("2026-11-22.png: it is of another day"), std::string::npos);
  EXPECT_NE(loaded.skipped[1].find("2026-11-24.png: it is damaged"), std::string::npos);
  const LoadedDays listed = list_days(folder.path(), test::kMadeUpFrame);
  ASSERT_EQ(listed.days.size(), 2U);
  EXPECT_EQ(listed.days[0].width, 4);
  EXPECT_TRUE(listed.days[0].packed.empty());
  EXPECT_EQ(listed.skipped, loaded.skipped);
}

}  // namespace
}  // namespace madori::mapping
