// The way of a mapped log, between the scans too.
#include "app/mapping_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "app/mapped_site.hpp"
#include "mapping/site/atomic_file.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

Stamp second(double s) {
  return stamp_from_seconds(s);
}

/// The wheels alone, ten readings a second, one metre each.
class Wheels final : public sensors::LogReader {
 public:
  std::optional<sensors::LogRecord> next() override {
    if (at_ == 50) return std::nullopt;
    const double s = 0.1 * at_++;
    return OdometryReading{second(s), {10.0 * s, 0.0, 0.0}};
  }

 private:
  int at_ = 0;
};

/// Ends with a map that was told it.
class Told final : public localization::Mapper {
 public:
  explicit Told(localization::FinishedMap map) : map_(std::move(map)) {}
  PoseEstimate on_odometry(const OdometryReading& reading) override {
    PoseEstimate pose;
    pose.stamp = reading.stamp;
    return pose;
  }
  PoseEstimate on_scan(Stamp, const localization::ScanPoints&, const Point2<Base>&) override { return {}; }
  [[nodiscard]] localization::FinishedMap finish() override { return std::move(map_); }

 private:
  localization::FinishedMap map_;
};

MappingRun run_of(localization::FinishedMap map) {
  Wheels wheels;
  Told mapper(std::move(map));
  return run_mapper(wheels, test::planar_lidar({}), mapper);
}

localization::FinishedMap two_scans() {
  localization::FinishedMap map;
  map.scans = {{second(1.0), {0.0, 5.0, 0.0}}, {second(2.0), {10.0, 5.0, 0.0}}};
  return map;
}

bool is_known_at(const MappingRun& run, double s) {
  return std::any_of(run.at_last.begin(), run.at_last.end(),
                     [&](const auto& p) { return std::abs(to_seconds(p.stamp - second(s))) < 0.01; });
}

TEST(MappingRun, LaysTheWheelsWayOnTheScans) {
  const MappingRun run = run_of(two_scans());
  ASSERT_FALSE(run.at_last.empty());
  EXPECT_TRUE(is_known_at(run, 4.5));
  for (const auto& pose : run.at_last) {
    EXPECT_NEAR(pose.map_from_base.x_m(), 10.0 * (to_seconds(pose.stamp.time_since_epoch()) - 1.0), 1e-6);
    EXPECT_NEAR(pose.map_from_base.y_m(), 5.0, 1e-6);
  }
}

/// When between two scans it was carried the wheels do not say, be the scan after it in the map or not.
TEST(MappingRun, KnowsNothingBetweenTheScansWhereTheVehicleWasCarried) {
  localization::FinishedMap within = two_scans();
  within.carried = {second(2.0)};
  EXPECT_FALSE(is_known_at(run_of(std::move(within)), 1.5));
  localization::FinishedMap after = two_scans();
  after.carried = {second(3.0)};
  const MappingRun run = run_of(std::move(after));
  EXPECT_TRUE(is_known_at(run, 1.5));
  EXPECT_FALSE(is_known_at(run, 2.5));
  EXPECT_FALSE(is_known_at(run, 3.5));
}

/// A map lies in a frame of its own: a site that is mapped anew keeps its vehicle, and no route of before.
TEST(MappedSite, ReplacesTheMapOfASiteAndNotItsVehicle) {
  const test::TemporaryFolder folder;
  const auto site = folder.path() / "site";
  MappedSite mapped;
  mapped.walls = {{1, {{1.0, 1.0}, {9.0, 1.0}}}, {2, {{1.0, 1.0}, {1.0, 5.0}}}};
  mapped.width_px = 500;
  mapped.height_px = 300;
  save_mapped_site(mapped, site, {"hall", "a.log", {}, {}, {{"driven_way.csv", "time_s,x_m,y_m,yaw_rad\n"}}});
  mapping::Site record = mapping::load_site(site);
  record.vehicle.length_m = 2.5;
  record.sensors = {{"front", "lms1xx", 2.0, 0.0, 0.25, 0.0}};
  record.low_bodies_guarded_by = "a bumper";
  record.georeference = mapping::GeoreferenceRecord{35.0, 136.0, 0.0};
  mapping::save_site(site, record);
  std::filesystem::create_directories(site / "routes");
  folder.write("site/routes/path.csv", "id\n");
  folder.write("site/routes/tree.csv", "id\n");
  folder.write("site/other_lines.csv", "id,x1,y1,x2,y2\n");

  save_mapped_site(mapped, site, {"hall again", "b.log"});
  const mapping::Site now = mapping::load_site(site);
  EXPECT_EQ(now.name, "hall again");
  EXPECT_DOUBLE_EQ(now.vehicle.length_m, 2.5);
  EXPECT_EQ(now.sensors, record.sensors);
  EXPECT_EQ(now.low_bodies_guarded_by, "a bumper");
  EXPECT_FALSE(now.georeference);
  for (const char* file : {"routes/path.csv", "routes/tree.csv", "other_lines.csv", "driven_way.csv"})
    EXPECT_FALSE(std::filesystem::exists(site / file)) << file;
}

}  // namespace
}  // namespace madori::app
