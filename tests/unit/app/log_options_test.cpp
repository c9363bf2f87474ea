#include "app/log_options.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

TEST(LogOptions, TakeTheWheelsAndForACaptureTheFirstLidarOfTheSiteThatMakesClouds) {
  mapping::Site site;
  site.vehicle.wheel_radius_m = 0.08;
  site.vehicle.half_wheel_separation_m = 0.21;
  site.sensors = {{"guard", "s300", 9.0, 9.0, 9.0, 9.0}, {"roof", "vlp16", 0.3, -0.1, 1.2, 90.0}};
  const sensors::LogOptions options = log_options(site, {"wheels.csv", "", "", "", ""});
  EXPECT_EQ(options.wheels, "wheels.csv");
  EXPECT_DOUBLE_EQ(options.geometry.left_radius_m, 0.08);
  EXPECT_DOUBLE_EQ(options.geometry.half_separation_m, 0.21);
  EXPECT_DOUBLE_EQ(options.base_from_lidar.x_m(), 0.3);
  EXPECT_DOUBLE_EQ(options.base_from_lidar.yaw_rad(), kPi / 2.0);
  EXPECT_DOUBLE_EQ(options.lidar_height_m, 1.2);
  EXPECT_EQ(options.lidar, 1U);
  sensors::CloudRecord record{"vlp16", {}, options.base_from_lidar, options.lidar_height_m};
  record.cloud.points = {{2.0F, 0.0F, 0.5F, 0.0F, 0, 0}};
  const CloudPoint p = sensors::cloud_in_base(record).points.front();
  EXPECT_NEAR(p.x_m, 0.3, 1e-6);
  EXPECT_NEAR(p.y_m, 1.9, 1e-6);
  EXPECT_NEAR(p.z_m, 1.7, 1e-6);
}

TEST(LogOptions, NameEachLidarAsOurRecordingsDo) {
  mapping::Site site;
  site.sensors = {{"front left", "lms1xx", 0.4, 0.1, 0.2, 0.0}, {"roof", "vlp16", 0.3, -0.1, 1.2, 90.0}};
  const auto lidars = log_options(site).bag.lidars;
  ASSERT_EQ(lidars.size(), 2U);
  EXPECT_EQ(lidars[0].frame, "front_left");
  EXPECT_TRUE(lidars[0].planar);
  EXPECT_FALSE(lidars[1].planar);
  EXPECT_DOUBLE_EQ(lidars[1].height_m, 1.2);
  EXPECT_EQ(log_lidars(site).at(1).name, "roof");
  LogArguments arguments;
  arguments.lidar = "front left";
  ASSERT_EQ(log_options(site, arguments).bag.lidars.size(), 1U);
  EXPECT_EQ(log_options(site, arguments).bag.lidars[0].place, 0U);
  arguments.lidar = "rear";
  EXPECT_THROW((void)log_options(site, arguments), Error);
  EXPECT_EQ(log_options({}).bag.lidars.size(), 1U) << "at the Base origin";
}

}  // namespace
}  // namespace madori::app
