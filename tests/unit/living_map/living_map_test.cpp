#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "app/keeping/site_keeper.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/living_map_file.hpp"
#include "app/learned/map_layers.hpp"
#include "app/learned/map_watch.hpp"
#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

using localization::CellState;

PoseEstimate sure_pose(double t_s, const Transform2<Map, Base>& at) {
  PoseEstimate pose;
  pose.stamp = stamp_from_seconds(t_s);
  pose.map_from_base = at;
  pose.covariance *= 1e-4;
  pose.health.state = LocalizationState::Localized;
  return pose;
}

/// A sweep of a level lidar in a hall.
PointCloud<Base> sweep_at(const Transform2<Map, Base>& pose, double t_s) {
  std::mt19937 engine(3);
  const LaserScan scan =
      test::simulate_scan(test::laboratory_hall(), pose, test::full_turn(720, 30.0), engine);
  PointCloud<Base> cloud;
  cloud.stamp = stamp_from_seconds(t_s);
  const auto points = localization::scan_points(scan, {});
  for (std::size_t i = 0; i < points.size(); ++i)
    cloud.points.push_back({points.x_m[i], points.y_m[i], 0.3F, 0.0F, 0, 0});
  return cloud;
}

/// Looks from a place now and then, as a vehicle that stands does; waits until each was seen.
void stand(MapWatch& watch, double begin_s, int looks) {
  const Transform2<Map, Base> pose(7.0, 3.3, 0.4);
  const LidarModel lidar = test::planar_lidar({0.0, 0.0, 0.3, 0.0});
  for (int i = 0; i < looks; ++i) {
    const auto before = watch.looks();
    const double t_s = begin_s + 0.5 * i;
    EXPECT_TRUE(watch.see(sweep_at(pose, t_s), lidar, sure_pose(t_s, pose)));
    EXPECT_FALSE(watch.see({}, lidar, sure_pose(t_s + 0.05, pose)));
    while (watch.looks() == before) std::this_thread::yield();
  }
}

constexpr Point2<Map> kOnTheConveyor{5.41, 3.1};

TEST(LivingMap, IsKeptBetweenDrivesAndGoesOn) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const mapping::Walls drawn(walls.begin(), walls.begin() + 10);  // without the machines
  {
    MapWatch watch(begin_living_map(folder.path(), drawn).map);
    stand(watch, 1e6, 8);
    EXPECT_EQ(watch.map().state_at(kOnTheConveyor), CellState::SemiStatic);
    EXPECT_EQ(watch.map().state_at({7.0, 0.02}), CellState::Static);
    save_living_map(folder.path(), watch.map(), drawn);
  }
  LivingMap again = begin_living_map(folder.path(), drawn);
  EXPECT_TRUE(again.message.empty()) << again.message;
  MapWatch watch(std::move(again.map));
  stand(watch, 1e6 + 86'400.0, 2);
  EXPECT_EQ(watch.map().state_at(kOnTheConveyor), CellState::Static);
}

TEST(LivingMap, OfOtherWallsOrDamagedIsNotUsedAndSaysWhy) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  MapWatch watch{begin_living_map(folder.path(), walls).map};
  stand(watch, 1e6, 3);
  save_living_map(folder.path(), watch.map(), walls);
  const mapping::Walls others(walls.begin(), walls.end() - 1);
  EXPECT_NE(begin_living_map(folder.path(), others).message.find("walls have changed"), std::string::npos);
  const auto file = folder.path() / kLivingMapFile;
  mapping::write_file_atomically(file, mapping::file_content(file).substr(0, 500));
  const LivingMap damaged = begin_living_map(folder.path(), walls);
  EXPECT_NE(damaged.message.find("damaged"), std::string::npos);
  EXPECT_EQ(damaged.map.state_at(kOnTheConveyor), CellState::Unseen);
  EXPECT_THROW((void)load_living_map(file), Error);
  EXPECT_THROW((void)load_living_map(folder.path() / "none.bin"), Error);
}

TEST(LivingMap, LearnsNothingWhileThePlaceIsNotSure) {
  MapWatch watch{localization::HybridMap()};
  const LidarModel lidar = test::planar_lidar({0.0, 0.0, 0.3, 0.0});
  PoseEstimate pose = sure_pose(10.0, {});
  pose.health.state = LocalizationState::Degraded;
  EXPECT_FALSE(watch.see({}, lidar, pose));
  pose = sure_pose(10.0, {});
  pose.covariance(1, 1) = 0.04;
  EXPECT_FALSE(watch.see({}, lidar, pose));
}

TEST(LivingMap, TheSitesKeeperWritesItAtTheEnd) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const auto map_watch = std::make_shared<MapWatch>(begin_living_map(folder.path(), walls).map);
  const auto wall_watch =
      std::make_shared<WallWatch>(walls, Point2<Base>{}, folder.path() / kReliabilityFile);
  stand(*map_watch, 1e6, 3);
  { SiteKeeper keeper(folder.path(), walls, wall_watch, map_watch); }
  EXPECT_EQ(load_living_map(folder.path() / kLivingMapFile).cells().size() > 500, true);
}

TEST(LivingMap, LayersShowEachCellOnce) {
  MapWatch watch{begin_living_map("no such folder", test::laboratory_hall()).map};
  stand(watch, 1e6, 8);
  const localization::HybridMap map = watch.map();
  const GridMap fixed = layer_of(map, MapLayer::Static);
  const GridMap semi = layer_of(map, MapLayer::SemiStatic);
  const GridMap free = layer_of(map, MapLayer::Free);
  const auto counts = to_json(map);
  const auto of = [](const GridMap& grid, int value) {
    return static_cast<std::size_t>(std::count(grid.pixels.begin(), grid.pixels.end(), value));
  };
  EXPECT_EQ(of(fixed, 0), counts["static"].get<std::size_t>());
  EXPECT_EQ(of(semi, 0), counts["semi_static"].get<std::size_t>());
  EXPECT_EQ(of(free, 254), counts["free"].get<std::size_t>() + counts["taken_away"].get<std::size_t>());
  EXPECT_GT(of(fixed, 0), 100U);
  EXPECT_GT(of(free, 254), 500U);
  const auto places = occupied_cells(fixed);
  for (const Point2<Map>& p : places) EXPECT_EQ(map.state_at(p), CellState::Static);
}

}  // namespace
}  // namespace madori::app
