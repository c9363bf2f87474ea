#include "mapping/days/day_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mapping/days/map_frame.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/days/made_up_day.hpp"

namespace madori::mapping {
namespace {

DayMap any_day() {
  DayMap map = test::made_up_day("2026-11-25", {" #.s", "mt..", "   #"});
  map.cell_m = 0.25;
  map.set(1, 4, {DayState::Static, 17});
  map.set(0, 3, {DayState::Free, 400});
  return map;
}

TEST(CivilDay, IsReadInOneFormOnly) {
  EXPECT_EQ(to_text(*civil_day("2026-02-28")), "2026-02-28");
  EXPECT_EQ(*civil_day("2024-03-01") - *civil_day("2024-02-28"), std::chrono::days(2));
  for (const char* text :
       {"", "2026-2-28", "2026-02-29", "2026-13-01", "2026-00-10", "2026-11-31", "2026/11/25", "+026-11-25",
        "2026-11-2 ", "2026-11-25.png", "../../etc/p", "20261-11-2"})
    EXPECT_FALSE(civil_day(text)) << text;
}

TEST(DayFile, ComesBackAsItWas) {
  const DayMap map = any_day();
  const auto read = parse_day(day_png(map));
  ASSERT_TRUE(read.ok()) << read.reason();
  EXPECT_EQ(read.value().day, map.day);
  EXPECT_EQ(read.value().frame, map.frame);
  EXPECT_EQ(read.value().cell_m, map.cell_m);
  EXPECT_EQ(read.value().packed, map.packed);
  EXPECT_EQ(read.value().at(1, 4), (DayCell{DayState::Static, 17}));
  EXPECT_EQ(read.value().at(0, 3), (DayCell{DayState::Free, kOldestDays}));  // older than can be told
  EXPECT_EQ(read.value().at(-2, 5).state, DayState::Unseen);
  EXPECT_EQ(read.value().at(-2, 6).state, DayState::Unseen);  // outside
}

/// Every byte changed and every length cut: refused, or (in a chunk that a PNG ends before) as it was.
TEST(DayFile, DamagedOnesAreRefused) {
  const std::string good = day_png(any_day());
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x20);
    const auto read = parse_day(bad);
    const bool harmless = read.ok() && read.value().packed == any_day().packed;
    EXPECT_TRUE(!read.ok() || (harmless && i + 4 >= good.size())) << "byte " << i;
    EXPECT_FALSE(parse_day(std::string_view(good).substr(0, i)).ok()) << "cut at " << i;
  }
}

TEST(DayFile, ValuesThatCannotBeAreRefused) {
  const auto refuses = [](auto change) {
    DayMap map = any_day();
    change(map);
    return !parse_day(day_png(map)).ok();
  };
  EXPECT_FALSE(refuses([](DayMap&) {}));
  EXPECT_TRUE(refuses([](DayMap& map) { map.packed[3] = 252; }));
  EXPECT_TRUE(refuses([](DayMap& map) { map.cell_m = 0.0; }));
  EXPECT_TRUE(refuses([](DayMap& map) { map.cell_m = std::nan(""); }));
  EXPECT_TRUE(refuses([](DayMap& map) { map.frame = "0123"; }));
  EXPECT_TRUE(refuses([](DayMap& map) { map.frame = "../../../../etc/"; }));
  EXPECT_TRUE(refuses([](DayMap& map) { map.column = 1 << 30; }));
}

TEST(MapFrame, StaysWithTheWallsAndChangesWithTheScale) {
  const test::TemporaryFolder folder;
  folder.write("drawing.png", "some bytes");
  Site site;
  site.drawing = {"drawing.png", 1200, 800};
  site.scale.emplace().m_per_px = 0.05;
  const std::string frame = map_frame(folder.path(), site);
  site.name = "another name";
  site.vehicle.length_m = 2.0;
  EXPECT_EQ(map_frame(folder.path(), site), frame);
  site.scale->m_per_px = 0.0501;
  EXPECT_NE(map_frame(folder.path(), site), frame);
  site.scale->m_per_px = 0.05;
  folder.write("drawing.png", "another drawing");
  EXPECT_NE(map_frame(folder.path(), site), frame);
}

}  // namespace
}  // namespace madori::mapping
