// Every configuration that is shipped below data/ can be loaded by the code that is shipped with it.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/transform2.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/strict_yaml.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_check.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "planning/route_graph/vehicle_fit.hpp"

namespace madori {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(MADORI_SOURCE_DIR) / "data";
const fs::path kSample = kData / "sample_factory";

std::vector<fs::path> shipped(const std::string& name) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(kData))
    if (entry.path().filename() == name) found.push_back(entry.path());
  return found;
}

TEST(ShippedData, EverySiteLoads) {
  for (const auto& file : shipped("site.yaml")) EXPECT_NO_THROW((void)mapping::load_site(file.parent_path()));
}

TEST(ShippedData, EveryRouteFolderLoadsWithoutAFault) {
  const auto files = shipped("tree.csv");
  EXPECT_GE(files.size(), 2U);
  for (const auto& file : files)
    for (const auto& finding : planning::read_routes(file.parent_path()).findings)
      ADD_FAILURE() << finding.text();
}

TEST(ShippedData, EveryYamlFileIsWellFormed) {
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kData)) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW((void)mapping::StrictYaml::load(entry.path()));
    ++files;
  }
  EXPECT_GE(files, 2U);
}

/// No leg leads through a true wall or passes one closer than half the vehicle's width.
void expect_drivable(const std::string& routes, const Transform2<Map, Map>& map_from_factory) {
  std::vector<Segment2<Map>> walls;
  for (const auto& wall : mapping::load_walls(kSample / "true_walls.csv"))
    walls.push_back(map_from_factory * wall.segment);
  ASSERT_GT(walls.size(), 100U);
  planning::RouteCheckOptions options;
  options.vehicle = planning::outline_of(mapping::VehicleRecord{});
  for (const auto& finding : planning::check_routes(planning::load_routes(kSample / routes), walls, options))
    ADD_FAILURE() << routes << ": " << finding.text();
}

TEST(ShippedData, TheSampleRoutesAreDrivable) {
  expect_drivable("routes_factory", {});
  auto meta = mapping::StrictYaml::load(kSample / "meta.yaml");
  auto frame = meta.section("scan").section("map_from_factory");
  expect_drivable("routes_scan", {frame.number("x_m", -100, 100), frame.number("y_m", -100, 100),
                                  to_rad(frame.number("yaw_deg", -180, 180))});
}

}  // namespace
}  // namespace madori
