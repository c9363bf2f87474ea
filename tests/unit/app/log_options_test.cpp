#include "app/log_options.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"

namespace madori::app {
namespace {

TEST(LogOptions, TakeTheWheelsAndTheFirstLidarOfTheSite) {
  mapping::Site site;
  site.vehicle.wheel_radius_m = 0.08;
  site.vehicle.half_wheel_separation_m = 0.21;
  site.sensors = {{"guard", "s300", 9.0, 9.0, 9.0, 9.0}, {"roof", "vlp16", 0.3, -0.1, 1.2, 90.0}};
  const sensors::LogOptions options = log_options(site, "wheels.csv");
  EXPECT_EQ(options.wheels, "wheels.csv");
  EXPECT_DOUBLE_EQ(options.geometry.left_radius_m, 0.08);
  EXPECT_DOUBLE_EQ(options.geometry.half_separation_m, 0.21);
  EXPECT_DOUBLE_EQ(options.base_from_lidar.x_m(), 0.3);
  EXPECT_DOUBLE_EQ(options.base_from_lidar.yaw_rad(), kPi / 2.0);
  EXPECT_DOUBLE_EQ(options.lidar_height_m, 1.2);
  sensors::CloudRecord record{"vlp16", {}, options.base_from_lidar, options.lidar_height_m};
  record.cloud.points = {{2.0F, 0.0F, 0.5F, 0.0F, 0, 0}};
  const CloudPoint p = sensors::cloud_in_base(record).points.front();
  EXPECT_NEAR(p.x_m, 0.3, 1e-6);
  EXPECT_NEAR(p.y_m, 1.9, 1e-6);
  EXPECT_NEAR(p.z_m, 1.7, 1e-6);
}

}  // namespace
}  // namespace madori::app
