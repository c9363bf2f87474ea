#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/keeping/site_keeper.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/living_map_file.hpp"
#include "app/learned/map_layers.hpp"
#include "app/learned/map_watch.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "mapping/days/day_archive.hpp"
#include "mapping/georeference/geotiff.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_transaction.hpp"
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
  stand(watch, 1e6 + 2.0 * 86'400.0, 2);
  EXPECT_EQ(watch.map().state_at(kOnTheConveyor), CellState::Static);
}

/// A clock that was a year ahead on an earlier day.
TEST(LivingMap, WhatWasStampedLaterThanNowHoldsNothingUp) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const mapping::Walls drawn(walls.begin(), walls.begin() + 10);
  const double now_s = to_seconds(clock_now().time_since_epoch());
  {
    MapWatch watch(begin_living_map(folder.path(), drawn).map);
    stand(watch, now_s - 2.0 * 86'400.0, 2);
    stand(watch, now_s + 365.0 * 86'400.0, 2);
    save_living_map(folder.path(), watch.map(), drawn);
  }
  MapWatch watch(begin_living_map(folder.path(), drawn).map);
  EXPECT_LE(watch.map().newest(), clock_now());
  stand(watch, now_s + 86'400.0, 8);  // the day after
  EXPECT_EQ(watch.map().newest(), stamp_from_seconds(now_s + 86'400.0 + 3.5));
  EXPECT_EQ(watch.map().state_at(kOnTheConveyor), CellState::Static);  // on three days
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
  { SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, wall_watch, map_watch); }
  EXPECT_EQ(load_living_map(folder.path() / kLivingMapFile).cells().size() > 500, true);
  EXPECT_TRUE(mapping::kept_days(folder.path()).empty());  // nobody said in which frame
}

TEST(LivingMap, TheSitesKeeperKeepsWhatItReadsOfTheDay) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const auto map_watch = std::make_shared<MapWatch>(begin_living_map(folder.path(), walls).map);
  const auto wall_watch =
      std::make_shared<WallWatch>(walls, Point2<Base>{}, folder.path() / kReliabilityFile);
  constexpr double kDay_s = 86'400.0;
  stand(*map_watch, 20'000 * kDay_s + 3600.0, 8);
  const std::string frame = "0123456789abcdef";
  { SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, wall_watch, map_watch, frame); }
  const auto days = mapping::kept_days(folder.path());
  ASSERT_EQ(days.size(), 1U);
  EXPECT_EQ(mapping::to_text(days[0]), "2024-10-04");
  const auto day = mapping::load_day(folder.path(), days[0]);
  ASSERT_TRUE(day.ok()) << day.reason();
  EXPECT_EQ(day.value().frame, frame);
  std::size_t fixed = 0;
  for (int row = 0; row < day.value().height; ++row)
    for (int column = 0; column < day.value().width; ++column)
      fixed += day.value().at(day.value().column + column, day.value().row + row).state ==
               mapping::DayState::Static;
  EXPECT_EQ(fixed, to_json(map_watch->map())["static"].get<std::size_t>());
  EXPECT_GT(fixed, 100U);
}

/// A wall that a person takes out of the walls: what was seen stays. Another scale: it does not.
TEST(LivingMap, GoesOnWhenWallsAreEditedButNotWhenTheDrawingIsScaled) {
  const test::TemporaryFolder folder;
  const auto save = [&](const mapping::Walls& walls, double m_per_px) {
    mapping::Site site;
    site.drawing = {"drawing.png", 1000, 500};
    site.scale.emplace().m_per_px = m_per_px;
    site.scale->method = "known";
    mapping::SiteTransaction change(folder.path());
    change.write("site.yaml", mapping::site_yaml(site));
    change.write("walls.csv", mapping::walls_csv(walls));
    change.commit();
  };
  const mapping::Walls walls = test::laboratory_hall();
  save(walls, 0.05);
  MapWatch watch{begin_living_map(folder.path(), walls).map};
  stand(watch, 1e6, 3);
  save_living_map(folder.path(), watch.map(), walls);
  const mapping::Walls fewer(walls.begin(), walls.end() - 1);
  save(fewer, 0.05);
  const LivingMap edited = begin_living_map(folder.path(), fewer);
  EXPECT_EQ(edited.message, "");
  EXPECT_EQ(edited.map.state_at({7.0, 0.02}), CellState::Static);
  save(fewer, 0.051);
  EXPECT_NE(begin_living_map(folder.path(), fewer).message.find("walls have changed"), std::string::npos);
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

/// A pixel's corners on Earth are where the site's georeference has them.
TEST(LivingMap, AGeoTiffLiesWhereTheSiteLies) {
  const mapping::GeoreferenceRecord place{35.0, 137.0, 30.0};
  const std::vector<std::uint8_t> pixels{0, 254, 205, 254, 0, 0};
  const test::TemporaryFolder folder;
  for (const bool on_earth : {true, false}) {
    const auto georeference = on_earth ? std::optional(place) : std::nullopt;
    const auto file =
        folder.write("map.tif", mapping::geotiff({0.25, {4.0, -2.0}, 3, 2, pixels}, georeference));
    const std::unique_ptr<GDALDataset> tiff(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    ASSERT_NE(tiff, nullptr);
    std::array<std::uint8_t, 6> read{};
    ASSERT_EQ(tiff->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 3, 2, read.data(), 3, 2, GDT_Byte, 0, 0),
              CE_None);
    EXPECT_TRUE(std::equal(read.begin(), read.end(), pixels.begin()));
    std::array<double, 6> t{};
    ASSERT_EQ(tiff->GetGeoTransform(t.data()), CE_None);
    const Point2<Map> corner{4.0 + 2 * 0.25,
                             -2.0 + 1 * 0.25};  // between the second and third column and the rows
    const double x = t[0] + 2.0 * t[1] + t[2], y = t[3] + 2.0 * t[4] + t[5];
    EXPECT_EQ(tiff->GetSpatialRef() != nullptr, on_earth);
    const mapping::LatLon truth = mapping::place_of(place, corner);
    const Point2<Enu> enu = mapping::LocalPlane({35.0, 137.0}).enu_of(truth);
    EXPECT_NEAR(x, on_earth ? enu.x_m : corner.x_m, 1e-4);
    EXPECT_NEAR(y, on_earth ? enu.y_m : corner.y_m, 1e-4);
  }
}

}  // namespace
}  // namespace madori::app
