#include "app/map_comparison.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/grid_map_file.hpp"
#include "core/result.hpp"
#include "localization/registration/point_map.hpp"
#include "mapping/site/atomic_file.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

std::vector<Point2<Map>> places_of(const mapping::Walls& walls, const Transform2<Map, Map>& moved = {}) {
  std::vector<Point2<Map>> places;
  for (const Point2<Map>& p : localization::sample_walls(walls, 0.05)) places.push_back(moved * p);
  return places;
}

double mean_m(const nlohmann::json& found, const char* way) {
  return found[way]["mean_m"].get<double>();
}

/// Against distances measured one by one.
TEST(MapComparison, DistancesAreThoseOfBruteForce) {
  const auto a = places_of(test::laboratory_hall());
  const auto b = places_of(test::laboratory_hall(), {0.3, -0.2, 0.05});
  const auto found = compare_maps(a, b, {0.05, MapAlignment::None, {}});
  const auto brute = [](const auto& of, const auto& to) {
    double sum = 0.0;
    for (const auto& p : of) {
      double nearest = 1e9;
      for (const auto& q : to) nearest = std::min(nearest, distance_m(p, q));
      sum += nearest;
    }
    return sum / static_cast<double>(of.size());
  };
  EXPECT_NEAR(mean_m(found, "building_to_map"), brute(b, a), 1e-9);
  EXPECT_NEAR(mean_m(found, "map_to_building"), brute(a, b), 1e-9);
}

TEST(MapComparison, WhatIsMissingAndWhatIsTooMuchShowsInOneDirectionEach) {
  const mapping::Walls hall = test::laboratory_hall();
  mapping::Walls part(hall.begin(), hall.end() - 6);
  const auto all = places_of(hall), some = places_of(part);
  const auto missing = compare_maps(some, all);
  EXPECT_GT(mean_m(missing, "building_to_map"), 0.05);
  EXPECT_LT(mean_m(missing, "map_to_building"), 0.005);
  const auto phantoms = compare_maps(all, some);
  EXPECT_LT(mean_m(phantoms, "building_to_map"), 0.005);
  EXPECT_GT(mean_m(phantoms, "map_to_building"), 0.05);
}

TEST(MapComparison, AMapIsFoundNearAndAnywhere) {
  const auto building = places_of(test::laboratory_hall());
  const auto near = compare_maps(places_of(test::laboratory_hall(), {0.6, 0.4, 0.15}), building);
  EXPECT_LT(mean_m(near, "building_to_map"), 0.02);
  const auto far = places_of(test::laboratory_hall(), {40.0, -7.0, 2.0});
  const auto found = compare_maps(far, building, {0.05, MapAlignment::Anywhere, {}});
  EXPECT_LT(mean_m(found, "building_to_map"), 0.02);
  EXPECT_LT(mean_m(found, "map_to_building"), 0.02);
}

/// The rule of map_server and nav2: free is what is below free_thresh. Nobody may plan through the unseen.
TEST(MapComparison, MapServerReadsTheUnknownAsUnknown) {
  const test::TemporaryFolder folder;
  GridMap map;
  map.width = map.height = 1;
  map.pixels = {205};
  save_grid_map(folder.path() / "static", map);
  const std::string yaml = mapping::file_content(folder.path() / "static.yaml");
  const std::string key = "free_thresh: ";
  const double free_below = std::stod(yaml.substr(yaml.find(key) + key.size()));
  EXPECT_GE((255 - 205) / 255.0, free_below);
  EXPECT_LT((255 - 254) / 255.0, free_below);
}

TEST(MapComparison, GridMapsAreReadAsTheyAreWritten) {
  const test::TemporaryFolder folder;
  GridMap map;
  map.cell_m = 0.1;
  map.origin = {2.0, -3.0};
  map.width = 4;
  map.height = 3;
  map.pixels.assign(12, 254);
  map.pixels[1] = 0;    // top row, second column
  map.pixels[2] = 205;  // unknown
  save_grid_map(folder.path() / "static", map);
  const auto places = occupied_places(folder.path() / "static.yaml", 0.05);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_NEAR(places[0].x_m, 2.15, 1e-9);
  EXPECT_NEAR(places[0].y_m, -3.0 + 0.25, 1e-9);
}

TEST(MapComparison, WhatIsNoMapIsRefusedInWords) {
  const test::TemporaryFolder folder;
  mapping::write_new_file(folder.path() / "map.txt", "x");
  mapping::write_new_file(folder.path() / "map.bin", "x");
  mapping::write_new_file(folder.path() / "map.yaml",
                          "image: none.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  for (const char* name : {"map.txt", "map.bin", "map.yaml"})
    EXPECT_THROW((void)occupied_places(folder.path() / name, 0.05), Error) << name;
}

}  // namespace
}  // namespace madori::app
