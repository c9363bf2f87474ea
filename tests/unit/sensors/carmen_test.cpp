#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/result.hpp"
#include "sensors/carmen/reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::sensors::carmen {
namespace {

using ::testing::HasSubstr;

ScanRecord scan_of(const std::string& line) {
  auto parsed = parse_line(line);
  if (!parsed || !parsed.value()) throw Error(line, "was not parsed", "");
  return std::get<ScanRecord>(parsed.value()->record);
}

std::string half_circle(const std::string& kind, int beams, const std::string& range) {
  std::string line = kind + " " + std::to_string(beams);
  for (int i = 0; i < beams; ++i) line += " " + range;
  return line + " 1.5 2 0.25 1 2 0.25 976052857.337246 host 976052857.4";
}

TEST(CarmenLine, ReadsOdometryToTheMicrosecond) {
  const auto parsed = parse_line("ODOM 1.25 -2.5 3.5 0 0 0 976052857.337246 robot 976052857.4\r");
  ASSERT_TRUE(parsed && parsed.value());
  const auto& reading = std::get<OdometryReading>(parsed.value()->record);
  EXPECT_EQ(reading.stamp.time_since_epoch(), std::chrono::microseconds(976052857337246));
  EXPECT_DOUBLE_EQ(reading.odom_from_base.x_m(), 1.25);
  EXPECT_DOUBLE_EQ(reading.odom_from_base.y_m(), -2.5);
  EXPECT_NEAR(reading.odom_from_base.yaw_rad(), 3.5 - 2.0 * kPi, 1e-12);
}

TEST(CarmenLine, SpreadsBeamsByTheirCount) {
  struct Case {
    int beams;
    double step_deg;
  };
  for (const auto [beams, step_deg] :
       {Case{180, 1.0}, Case{360, 0.5}, Case{181, 1.0}, Case{361, 0.5}, Case{720, 0.25}, Case{721, 0.25},
        Case{400, 0.25}, Case{401, 0.25}, Case{101, 1.0}}) {
    const LaserScan scan = scan_of(half_circle("FLASER", beams, "2.5")).scan;
    ASSERT_EQ(scan.ranges_m.size(), static_cast<std::size_t>(beams));
    const bool narrow = beams == 101 || beams == 400 || beams == 401;
    EXPECT_NEAR(to_deg(scan.angle_min_rad), narrow ? -50.0 : -90.0, 1e-12);
    EXPECT_NEAR(to_deg(scan.angle_step_rad), step_deg, 1e-12);
    EXPECT_FLOAT_EQ(scan.ranges_m.back(), 2.5F);
  }
}

TEST(CarmenLine, AnyOtherCountNeedsTheAnglesOfThePARAMs) {
  const std::string line = half_circle("FLASER", 270, "2.5");
  const auto refused = parse_line(line);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.reason(), HasSubstr("laser_front_laser_fov"));
  LogParams params;
  params.take("PARAM laser_front_laser_fov 270.0 nohost 0");
  params.take("PARAM laser_rear_laser_fov 90.0 nohost 0");
  auto parsed = parse_line(line, params);
  ASSERT_TRUE(parsed);
  const LaserScan scan = std::get<ScanRecord>(parsed.value()->record).scan;
  EXPECT_NEAR(to_deg(scan.angle_min_rad), -135.0, 1e-9);
  EXPECT_NEAR(to_deg(scan.angle_step_rad), 1.0, 1e-9);
  params.take("PARAM laser_front_laser_resolution 0.5 nohost 0");
  EXPECT_FALSE(parse_line(line, params)) << "270 beams of half a degree are no 270 degrees";
  EXPECT_TRUE(parse_line(half_circle("FLASER", 541, "2.5"), params));
}

TEST(CarmenLine, KnowsNoReturns) {
  for (const char* range : {"50", "50.0", "81.83", "81.91", "0", "nan", "-nan", "inf", "-inf"})
    EXPECT_EQ(scan_of(half_circle("FLASER", 180, range)).scan.ranges_m.front(), LaserScan::kNoReturn)
        << range;
  EXPECT_FLOAT_EQ(scan_of(half_circle("FLASER", 180, "49.91")).scan.ranges_m.front(), 49.91F);
}

TEST(CarmenLine, TheRearLaserLooksBack) {
  const ScanRecord rear = scan_of(half_circle("RLASER", 181, "3"));
  EXPECT_NEAR(std::abs(rear.base_from_lidar.yaw_rad()), kPi, 1e-12);
  EXPECT_DOUBLE_EQ(rear.odom_from_base->x_m(), 1.0);
}

TEST(CarmenLine, ReadsRobotLaser) {
  const ScanRecord record = scan_of(
      "ROBOTLASER1 0 -1.57 3.14 0.0087 30.0 0.01 1 3 1.0 30.0 2.5 3 10 20 30 "
      "5 6 0.5 4.9 6 0.5 0.1 0.2 0.3 0.4 1000 1112.5 host 0.75");
  EXPECT_DOUBLE_EQ(record.scan.angle_min_rad, -1.57);
  EXPECT_DOUBLE_EQ(record.scan.angle_step_rad, 0.0087);
  EXPECT_EQ(record.scan.ranges_m, (std::vector<float>{1.0F, LaserScan::kNoReturn, 2.5F}));
  EXPECT_EQ(record.scan.intensities, (std::vector<float>{10.0F, 20.0F, 30.0F}));
  EXPECT_DOUBLE_EQ(record.odom_from_base->x_m(), 4.9);
  EXPECT_DOUBLE_EQ(to_seconds(record.scan.stamp), 1112.5);
}

TEST(CarmenLine, ARobotLaserWithoutAMaximumTakesTheUsualOne) {
  const ScanRecord record = scan_of(
      "ROBOTLASER1 0 -1.57 3.14 0.0087 0 0.01 1 3 1.0 81.91 2.5 0 5 6 0.5 4.9 6 0.5 0.1 0.2 0.3 0.4 1000 1 h "
      "0");
  EXPECT_EQ(record.scan.ranges_m, (std::vector<float>{1.0F, LaserScan::kNoReturn, 2.5F}));
}

TEST(CarmenLine, ReadsARawLaserWithoutPoses) {
  LogParams params;
  params.take("PARAM robot_frontlaser_offset 0.3 nohost 0");
  auto parsed =
      parse_line("RAWLASER1 0 -1.57 3.14 0.0087 30.0 0.01 0 3 1.0 30.0 2.5 0 1112.5 host 0.75", params);
  ASSERT_TRUE(parsed && parsed.value());
  const auto& record = std::get<ScanRecord>(parsed.value()->record);
  EXPECT_EQ(record.scan.ranges_m, (std::vector<float>{1.0F, LaserScan::kNoReturn, 2.5F}));
  EXPECT_DOUBLE_EQ(to_seconds(record.scan.stamp), 1112.5);
  EXPECT_DOUBLE_EQ(record.base_from_lidar.x_m(), 0.3);
  EXPECT_FALSE(record.odom_from_base);
}

TEST(CarmenLine, SkipsOtherMessages) {
  for (const char* line : {"", "   ", "# a comment", "PARAM robot_length 1", "SYNC tag 1 2 3"}) {
    const auto parsed = parse_line(line);
    ASSERT_TRUE(parsed) << line;
    EXPECT_FALSE(parsed.value()) << line;
  }
}

TEST(CarmenLine, RefusesDamage) {
  for (const std::string& line :
       {std::string("ODOM 1 2"), std::string("ODOM 1 2 nan 0 0 0 5 h 5"),
        std::string("ODOM 1 2 inf 0 0 0 5 h 5"), std::string("ODOM 1 2 3 0 0 0 1e300 h 5"),
        std::string("FLASER 180 1 2 3"), std::string("FLASER -1 1"), std::string("FLASER 99999999999 1"),
        std::string("FLASER 1 1 0 0 0 0 0 0 1 h 1"), half_circle("FLASER", 180, "1.2x"),
        std::string("ROBOTLASER1 0 0 0 0 30 0 0 1 1"), std::string("\x01\x02garbage")})
    EXPECT_FALSE(parse_line(line)) << line.substr(0, 40);
}

TEST(CarmenReader, KeepsTheOrderOfTheFileAndNamesTheBadLine) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.log",
                                 "# log\nODOM 0 0 0 0 0 0 5 h 5\nODOM 0 0 0 0 0 0 4 h 4\n"
                                 "ODOM 0 0 0 0 0 0 6 h 6\nODOM broken\n");
  CarmenReader reader(file);
  for (const double time_s : {5.0, 4.0, 6.0}) EXPECT_DOUBLE_EQ(to_seconds(stamp_of(*reader.next())), time_s);
  try {
    (void)reader.next();
    FAIL() << "a damaged line was accepted";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("a.log:5: is not `ODOM"));
  }
}

std::string posed_scan(const std::string& kind, const Transform2<Odom, Lidar>& laser,
                       const Transform2<Odom, Base>& robot, int time_s) {
  std::string line = kind + " 180";
  for (int i = 0; i < 180; ++i) line += " 1";
  for (const double number :
       {laser.x_m(), laser.y_m(), laser.yaw_rad(), robot.x_m(), robot.y_m(), robot.yaw_rad()})
    line += " " + std::to_string(number);
  return line + " " + std::to_string(time_s) + " h 0\n";
}

/// A drive with the laser 0.3 m ahead of the robot's centre; `drift` is what a mapper would have corrected.
std::string drive(double drift_m) {
  std::string log;
  for (int i = 0; i < 10; ++i) {
    const Transform2<Odom, Base> robot(0.2 * i, 0.0, 0.1 * i);
    const auto laser = robot * Transform2<Base, Lidar>(0.3, 0.0, 0.0);
    log += posed_scan("FLASER", {laser.x_m() + drift_m * i, laser.y_m(), laser.yaw_rad()}, robot, i);
  }
  return log;
}

TEST(CarmenReader, FindsAConstantMountingOnly) {
  const test::TemporaryFolder folder;
  CarmenReader mounted(folder.write("mounted.log", drive(0.0)));
  EXPECT_NEAR(std::get<ScanRecord>(*mounted.next()).base_from_lidar.x_m(), 0.3, 1e-5);
  CarmenReader corrected(folder.write("corrected.log", drive(0.05)));
  EXPECT_EQ(std::get<ScanRecord>(*corrected.next()).base_from_lidar.x_m(), 0.0);
}

/// As long as the vehicle stands, or drives straight on, nothing tells where its lasers sit.
TEST(CarmenReader, FindsEachLasersMountingHoweverLongTheVehicleStandsFirst) {
  const test::TemporaryFolder folder;
  std::string log;
  const Transform2<Base, Lidar> front(0.3, 0.0, 0.0), back(-0.2, 0.1, kPi);
  for (int i = 0; i < 900; ++i) {
    const double driven = std::max(0, i - 800);
    const Transform2<Odom, Base> robot(0.02 * driven, 0.0, 0.01 * driven);
    log += posed_scan("FLASER", robot * front, robot, i) + posed_scan("RLASER", robot * back, robot, i);
  }
  CarmenReader reader(folder.write("stands.log", log));
  const auto ahead = std::get<ScanRecord>(*reader.next()).base_from_lidar;
  EXPECT_NEAR(ahead.x_m(), 0.3, 1e-5);
  const auto behind = std::get<ScanRecord>(*reader.next()).base_from_lidar;
  EXPECT_NEAR(behind.x_m(), -0.2, 1e-5);
  EXPECT_NEAR(behind.y_m(), 0.1, 1e-5);
  EXPECT_NEAR(std::abs(behind.yaw_rad()), kPi, 1e-5);
}

TEST(CarmenReader, ReadsRawScansWhereNoOthersAre) {
  const test::TemporaryFolder folder;
  const std::string raw = "RAWLASER1 0 -1.57 3.14 1.57 30 0.01 0 3 1 2 3 0 7 h 0\n";
  CarmenReader only(folder.write("raw.log", raw));
  EXPECT_EQ(std::get<ScanRecord>(*only.next()).source, "RAWLASER1");
  CarmenReader both(folder.write("both.log", raw + drive(0.0)));
  EXPECT_EQ(std::get<ScanRecord>(*both.next()).source, "FLASER");
}

TEST(CarmenReader, NamesWhatItSkippedWhereThereIsNoScan) {
  const test::TemporaryFolder folder;
  CarmenReader reader(folder.write("a.log", "ODOM 0 0 0 0 0 0 5 h 5\nRAWLASER2 0\nNMEAGGA 1\n"));
  ASSERT_TRUE(reader.next());
  try {
    (void)reader.next();
    FAIL() << "a log without scans was taken for a whole one";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("NMEAGGA, RAWLASER2"));
  }
}

TEST(CarmenReader, ReadsTheBenchmarkLogs) {
  struct Case {
    const char* name;
    int scans, odometry, beams, backward;
  };
  for (const auto& [name, scans, odometry, beams, backward] :
       {Case{"intel", 910, 8812, 180, 4}, Case{"fr079", 4791, 143, 360, 0},
        Case{"aces", 440, 6746, 180, 0}}) {
    const auto file =
        std::filesystem::path(MADORI_SHARED_DATA) / "lidar2d" / name / (std::string(name) + ".log");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
    CarmenReader reader(file);
    int scan_count = 0, odometry_count = 0, backward_count = 0;
    Stamp last = Stamp::min();
    while (const auto record = reader.next()) {
      backward_count += stamp_of(*record) < last ? 1 : 0;
      last = stamp_of(*record);
      const auto* scan = std::get_if<ScanRecord>(&*record);
      ++(scan ? scan_count : odometry_count);
      if (!scan) continue;
      ASSERT_EQ(scan->scan.ranges_m.size(), static_cast<std::size_t>(beams));
      ASSERT_EQ(scan->base_from_lidar.yaw_rad(), 0.0);
    }
    EXPECT_EQ(scan_count, scans) << name;
    EXPECT_EQ(odometry_count, odometry) << name;
    EXPECT_EQ(backward_count, backward) << name;
  }
}

}  // namespace
}  // namespace madori::sensors::carmen
