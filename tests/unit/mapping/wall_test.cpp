#include "mapping/wall_map/wall.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

TEST(Walls, SurviveSavingAndLoading) {
  const test::TemporaryFolder folder;
  const Walls walls{{1, {{0.0, 1.5}, {2.25, -3.0}}}, {7, {{10.0, 10.0}, {10.0, 20.125}}}};
  EXPECT_EQ(load_walls(folder.write("walls.csv", walls_csv(walls))), walls);
}

TEST(Walls, KeepTheirProbabilitiesWhenTheyAreWrittenAgain) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("walls.csv", "id,x1,y1,x2,y2,probability\n3,0,0,1,1,0.75\n4,0,1,1,1,1\n");
  const Walls walls = load_walls(file);
  ASSERT_EQ(walls.size(), 2U);
  EXPECT_EQ(walls[0].probability, 0.75);
  EXPECT_EQ(walls[1].probability, 1.0);
  EXPECT_EQ(load_walls(folder.write("again.csv", walls_csv(walls))), walls);
}

TEST(Walls, RefuseABadRowWithItsLine) {
  const test::TemporaryFolder folder;
  for (const char* row :
       {"1,2,3,4", "1,2,3,4,nan", "1,2,3,4,5,6", "1,2,3,4,5,0.5,1", "a,2,3,4,5", "1,2,3,4,5x"}) {
    const auto file = folder.write("walls.csv", std::string("id,x1,y1,x2,y2\n0,0,0,1,1\n") + row + "\n");
    try {
      (void)load_walls(file);
      FAIL() << row << " was accepted";
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("walls.csv:3")) << row;
    }
  }
}

}  // namespace
}  // namespace madori::mapping
