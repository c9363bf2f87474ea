#include "mapping/days/day_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/unit/days/made_up_day.hpp"

namespace madori::mapping {
namespace {

std::vector<DayChange> between(const std::vector<std::string>& then, const std::vector<std::string>& now) {
  const std::vector<DayMap> days{test::made_up_day("2026-11-18", then), test::made_up_day("2026-11-25", now)};
  return changes_between(days);
}

TEST(DayChanges, WhatStoodAndIsFreeIsGoneAndTheOtherWayRoundIsNew) {
  const std::vector<std::string> with{"..........", "..ssss....", "..s##s....", "..........", ".........."};
  const std::vector<std::string> without{"..........", "..tt......", "..........", "..........",
                                         ".........."};
  const auto gone = between(with, without);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_EQ(gone[0].kind, ChangeKind::Gone);
  EXPECT_EQ(gone[0].cells, 8U);
  EXPECT_DOUBLE_EQ(gone[0].width_m, 1.0);
  EXPECT_DOUBLE_EQ(gone[0].height_m, 0.5);
  EXPECT_DOUBLE_EQ(gone[0].centre.x_m, 0.5);  // columns 0 to 3
  EXPECT_DOUBLE_EQ(gone[0].centre.y_m, 1.5);  // rows 5 and 6
  const auto added = between(without, with);
  ASSERT_EQ(added.size(), 1U);
  EXPECT_EQ(added[0].kind, ChangeKind::New);
  EXPECT_EQ(added[0].cells, 8U);
}

TEST(DayChanges, WhatWasUnseenOrMovesSaysNothing) {
  const std::vector<std::string> with{"..........", ".ssssssss.", ".........."};
  for (const char* row : {"          ", " mmmmmmmm "}) {
    EXPECT_TRUE(between(with, {"..........", row, ".........."}).empty());
    EXPECT_TRUE(between({"..........", row, ".........."}, with).empty());
  }
}

TEST(DayChanges, AFewCellsAreNoise) {
  const std::vector<std::string> empty(5, "........");
  EXPECT_TRUE(between({"........", "..ss....", "..ss....", "........", "........"}, empty).empty());
  EXPECT_EQ(between({"........", "..ssss..", "..ss....", "........", "........"}, empty).size(), 1U);
}

/// A wall whose face comes to lie in the next row of cells has not gone, nor come.
TEST(DayChanges, AWallInTheNextCellHasNotMoved) {
  EXPECT_TRUE(between({"..........", "..........", "##########", ".........."},
                      {"..........", "##########", "..........", ".........."})
                  .empty());
}

/// Beams that graze a machine's face, behind which nobody has ever seen, do not take it away.
TEST(DayChanges, AFaceBehindWhichNothingIsSeenHasNotGone) {
  EXPECT_TRUE(between({"..........", "ssssssssss", "          "}, {"..........", "..........", "          "})
                  .empty());
  EXPECT_EQ(
      between({"..........", "ssssssssss", "          "}, {"..........", "..........", ".........."}).size(),
      1U);
}

TEST(DayChanges, AWallThatIsTornDownBesideOneThatStaysIsGone) {
  const auto changes = between({"............", "###########.", "............"},
                               {"............", "##..........", "............"});
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].cells, 9U);  // with the cell beside the one that stands
}

TEST(DayChanges, WhatIsAlikeAndCloseByHasMoved) {
  const auto changes =
      between({".................", ".sss.............", ".sss.............", "................."},
              {".................", ".......sss.......", ".......sss.......", "................."});
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, ChangeKind::Moved);
  ASSERT_TRUE(changes[0].from);
  EXPECT_NEAR(changes[0].centre.x_m - changes[0].from->x_m, 1.5, 1e-9);
}

TEST(DayChanges, WhatIsFarOrOfAnotherSizeHasNotMoved) {
  const std::string floor(20, '.');
  const std::vector<std::string> then{floor, ".sss................", ".sss................", floor};
  EXPECT_EQ(between(then, {floor, "...............sss..", "...............sss..", floor}).size(),
            2U);  // 3.5 m
  EXPECT_EQ(between(then, {floor, "......ssssssss......", "......ssssssss......", floor}).size(), 2U);
}

TEST(DayChanges, OfTwoThatAreAlikeTheNearerHasMoved) {
  const auto changes = between(
      {"....................", ".sss................", ".sss................", "...................."},
      {"....................", "......sss...sss.....", "......sss...sss.....", "...................."});
  ASSERT_EQ(changes.size(), 2U);
  const auto moved = std::ranges::find(changes, ChangeKind::Moved, &DayChange::kind);
  ASSERT_NE(moved, changes.end());
  EXPECT_NEAR(moved->centre.x_m, (-2 + 7.5) * 0.25, 1e-9);
  EXPECT_EQ(std::ranges::count(changes, ChangeKind::New, &DayChange::kind), 1);
}

/// Days between tell when: last seen standing two days before the 21st, free from the 23rd on.
TEST(DayChanges, DatesAreThoseOfLooks) {
  const std::vector<std::string> with{".......", ".sssss.", "......."},
      without{".......", ".......", "......."}, unseen{".......", ".     .", "......."};
  std::vector<DayMap> days{test::made_up_day("2026-11-18", with), test::made_up_day("2026-11-21", with),
                           test::made_up_day("2026-11-22", unseen), test::made_up_day("2026-11-23", without),
                           test::made_up_day("2026-11-25", without)};
  for (int column = -1; column < 4; ++column) days[1].set(column, 4, {DayState::SemiStatic, 2});
  const auto gone = changes_between(days);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_EQ(to_text(gone[0].before), "2026-11-19");
  EXPECT_EQ(to_text(gone[0].since), "2026-11-23");
  std::ranges::reverse(days);  // as if it had come
  for (std::size_t i = 0; i < days.size(); ++i) days[i].day = *civil_day("2026-11-18") + std::chrono::days(i);
  const auto added = changes_between(days);
  ASSERT_EQ(added.size(), 1U);
  EXPECT_EQ(to_text(added[0].before), "2026-11-19");
  EXPECT_EQ(to_text(added[0].since), "2026-11-21");
}

DayMap random_day(std::mt19937& engine, const std::string& date) {
  std::vector<std::string> rows(20, std::string(30, '.'));
  for (int thing = 0; thing < 12; ++thing) {
    const char letter = ".ms#t "[engine() % 6];
    const std::size_t u = engine() % 24, v = engine() % 16, w = 1 + engine() % 6, h = 1 + engine() % 4;
    for (std::size_t y = v; y < v + h; ++y)
      for (std::size_t x = u; x < u + w; ++x) rows[y][x] = letter;
  }
  return test::made_up_day(date, rows);
}

/// A cell that is in a cluster, found by asking every cell by itself.
bool changed(const DayMap& then, const DayMap& now, const DayPlace& p) {
  return stands(then.at(p.column, p.row).state) && is_free(now.at(p.column, p.row).state);
}
bool surely(const DayMap& then, const DayMap& now, const DayPlace& p) {
  if (!changed(then, now, p)) return false;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      if (const auto s = now.at(p.column + du, p.row + dv).state; stands(s) || s == DayState::Unseen)
        return false;
  return true;
}

/// Laws over made-up buildings: of clusters, and of what becomes of them.
TEST(DayChanges, LawsHoldForMadeUpBuildings) {
  int clusters = 0, moved = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 engine(seed);
    const DayMap then = random_day(engine, "2026-11-18"), now = random_day(engine, "2026-11-25");
    EXPECT_TRUE(vanished(then, then).empty());
    const auto gone = vanished(then, now), added = vanished(now, then);
    std::vector<DayPlace> all;
    for (const DayCluster& c : gone) {
      EXPECT_TRUE(std::ranges::all_of(c.cells, [&](const DayPlace& p) { return changed(then, now, p); }));
      EXPECT_GE(std::ranges::count_if(c.cells, [&](const DayPlace& p) { return surely(then, now, p); }),
                static_cast<std::ptrdiff_t>(kLeastCells));
      for (const DayPlace& p : c.cells)
        if (surely(then, now, p)) all.push_back(p);
    }
    std::ranges::sort(all);
    EXPECT_EQ(std::ranges::adjacent_find(all), all.end()) << "a cell is in two clusters";
    clusters += static_cast<int>(gone.size());
    const std::vector<DayMap> days{then, now};
    const auto changes = changes_between(days);
    const auto of = [&](ChangeKind kind) {
      return static_cast<std::size_t>(std::ranges::count(changes, kind, &DayChange::kind));
    };
    EXPECT_EQ(of(ChangeKind::Gone) + of(ChangeKind::Moved), gone.size());
    EXPECT_EQ(of(ChangeKind::New) + of(ChangeKind::Moved), added.size());
    moved += static_cast<int>(of(ChangeKind::Moved));
    for (const DayChange& c : changes) {
      EXPECT_LE(c.before, c.since);
      EXPECT_LE(distance_m(c.from.value_or(c.centre), c.centre), 3.0);
    }
  }
  EXPECT_GT(clusters, 100);
  EXPECT_GT(moved, 10);
}

}  // namespace
}  // namespace madori::mapping
