#include "simulation/scenario/scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/result.hpp"
#include "simulation/factory.hpp"
#include "simulation/scenario/furniture.hpp"
#include "tests/support/small_hall.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::simulation {
namespace {

using testing::HasSubstr;

const char* const kHead = "madori_scenario: 1\nname: test\nstart: {x_m: 1, y_m: 2, yaw_deg: 90}\n";

std::string error_of(const std::string& body) {
  const test::TemporaryFolder folder;
  try {
    (void)load_scenario(folder.write("s.yaml", kHead + body));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Scenario, TheLeastFileGivesTheDocumentedDefaults) {
  const test::TemporaryFolder folder;
  const Scenario s = load_scenario(folder.write("s.yaml", kHead));
  EXPECT_EQ(s.seed, 1U);
  EXPECT_EQ(s.vlp16.noise_m, 0.03);
  EXPECT_EQ(s.vlp16.rate_hz, 10.0);
  EXPECT_NEAR(s.start.yaw_rad(), kPi / 2.0, 1e-12);
}

TEST(Scenario, NamesFileLineAndMendOfAMistake) {
  EXPECT_THAT(error_of("colour: red\n"), HasSubstr("colour: is not a known setting"));
  EXPECT_THAT(error_of("vlp16: {noise_m: -1}\n"), HasSubstr(":4: vlp16.noise_m: must lie between"));
  EXPECT_THAT(error_of("movers:\n  - {kind: dog, path: [[1, 2]]}\n"),
              HasSubstr("use one of: person, forklift"));
  EXPECT_THAT(error_of("movers:\n  - {kind: person, path: [[1, a]]}\n"), HasSubstr("is no [x, y]"));
  EXPECT_THAT(error_of("movers:\n  - {kind: person}\n"), HasSubstr("needs 1 points"));
  EXPECT_THAT(error_of("faults:\n  - {kind: checksum, device: vlp16, at_s: 1}\n"), HasSubstr("no checksum"));
  EXPECT_THAT(error_of("faults:\n  - {kind: slip, device: s300, at_s: 1}\n"), HasSubstr("one of the drive"));
  EXPECT_THAT(error_of("glass:\n  - {line: [[1, 1], [1, 1]]}\n"), HasSubstr("is no line"));
  EXPECT_THAT(error_of("doors:\n  - {kind: lift, line: [[1, 1]]}\n"), HasSubstr("needs 2 points"));
}

TEST(Scenario, AWallThatDoesNotExistIsNamed) {
  FactorySetup setup = test::small_hall();
  setup.scenario.building.missing_walls = {17};
  EXPECT_THROW(Factory{setup}, Error);
}

TEST(Scenario, EveryShippedOneLoadsAndRuns) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(MADORI_SOURCE_DIR "/data/scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    FactorySetup setup;
    setup.scenario = load_scenario(entry.path());
    if (setup.scenario.building.walls_file.empty()) setup.walls = test::small_hall().walls;
    Factory factory(setup);
    factory.step(std::chrono::milliseconds(200));
    EXPECT_TRUE(factory.collisions().empty()) << entry.path();
    EXPECT_FALSE(factory.take_packets().empty()) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 4);
}

std::vector<Segment2<Plan>> hall() {
  std::vector<Segment2<Plan>> walls;
  for (const auto& wall : test::small_hall(40.0, 25.0).walls)
    walls.push_back({{wall.segment.a.x_m, wall.segment.a.y_m}, {wall.segment.b.x_m, wall.segment.b.y_m}});
  return walls;
}

TEST(Furniture, ADayGivesOneArrangementAndTheNextAnother) {
  Scenario s = test::small_hall().scenario;
  s.furniture.count = 12;
  s.furniture.hide_walls_percent = 30.0;
  const auto places = [&] {
    std::vector<double> x;
    for (const auto& solid : place_furniture(hall(), s)) x.push_back(solid.centre.x_m);
    return x;
  };
  const auto today = places();
  EXPECT_EQ(today, places());
  s.furniture.day = 1;
  EXPECT_NE(today, places());
}

TEST(Furniture, HidesTheAskedShareOfTheWallsAndKeepsTheRoutesClear) {
  Scenario s = test::small_hall().scenario;
  s.furniture.count = 20;
  s.furniture.hide_walls_percent = 30.0;
  s.furniture.keep_clear = {{{5.0, 4.0}, {35.0, 4.0}, {35.0, 0.0}}};
  double hidden = 0.0;
  int pallets = 0;
  for (const auto& solid : place_furniture(hall(), s)) {
    if (solid.kind == SolidKind::Pallet) ++pallets;
    if (solid.kind == SolidKind::Clutter) hidden += solid.length_m;
    EXPECT_FALSE(std::abs(solid.centre.y_m - 4.0) < 1.2 && solid.centre.x_m > 5.0 && solid.centre.x_m < 35.0);
  }
  EXPECT_NEAR(hidden / 130.0, 0.30, 0.015);
  EXPECT_EQ(pallets, 20);
}

}  // namespace
}  // namespace madori::simulation
