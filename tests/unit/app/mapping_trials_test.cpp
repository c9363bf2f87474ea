// Random drives by hand through two rooms; tests/bench/bench_mapping_drive has many more of them.
#include <gtest/gtest.h>

#include "tests/support/mapping_trial.hpp"

namespace madori::test {
namespace {

void expect_right_map(const MappingTrial& trial) {
  const auto result = run_mapping_trial(trial);
  EXPECT_LE(result.map_to_building_m, 0.03) << trial.seed;
  EXPECT_LE(result.building_to_map_m, 0.03) << trial.seed;
  for (const auto& [where, off_m] : result.phantoms)
    ADD_FAILURE() << "seed " << trial.seed << ": a wall of " << where.length_m() << " m at " << where.a.x_m
                  << " " << where.a.y_m << ", " << off_m << " m off every true one";
}

TEST(MappingTrials, TheCeilingSeenThroughTheDoorIsNoWall) {
  MappingTrial trial;
  trial.keep_every_firing = 4;
  trial.seed = 12;  // turns on the spot where it sees the other room's ceiling past the door
  expect_right_map(trial);
}

TEST(MappingTrials, PersonsBeforeALowLidarAreNoWalls) {
  MappingTrial trial;
  trial.lidar = {"front", "lms1xx", 0.7, 0.0, 0.25, 0.0};
  trial.persons = 2;
  trial.seed = 3;
  expect_right_map(trial);
}

}  // namespace
}  // namespace madori::test
