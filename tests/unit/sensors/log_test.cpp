#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "sensors/deskew.hpp"
#include "sensors/open_log.hpp"
#include "sensors/pcap/reader.hpp"
#include "sensors/rosbag/bridge.hpp"
#include "sensors/rosbag/cloud_fields.hpp"
#include "sensors/rosbag/writer.hpp"
#include "sensors/vlp16/encode.hpp"
#include "tests/support/made_bag.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::sensors {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string error_of(const std::filesystem::path& file, const LogOptions& options = {}) {
  try {
    const auto log = open_log(file, options);
    while (log->next()) {
    }
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

LaserScan sample_scan(Stamp stamp) {
  LaserScan scan{stamp, std::chrono::microseconds(27),      -1.5, 0.01,
                 30.0,  {1.0F, LaserScan::kNoReturn, 2.5F}, {}};
  scan.intensities = {1.0F, 2.0F, 3.0F};
  return scan;
}

PointCloud<Lidar> sample_cloud(Stamp stamp) {
  PointCloud<Lidar> cloud{stamp, {}};
  for (int i = 0; i < 100; ++i)
    cloud.points.push_back({1.0F * static_cast<float>(i), -2.0F, 0.5F, 0.001F * static_cast<float>(i),
                            static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i % 16)});
  return cloud;
}

TEST(Bag, WhatIsWrittenIsReadInTheOrderOfTime) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "run.bag";
  const auto at = [](double seconds) { return stamp_from_seconds(1'700'000'000.0 + seconds); };
  {
    BagWriter writer(file);
    writer.write("/odom", OdometryReading{at(0.02), {1.0, 2.0, 0.5}});
    writer.write("/scan", sample_scan(at(0.01)));
    writer.write("/points", sample_cloud(at(0.03)));
    writer.write("/pose", PoseEstimate{});
    writer.write("/path", Path{{{{1.0, 2.0}, 0.5}}}, at(0.04));
    writer.write("/events", "started", at(0.05));
    writer.close();
  }
  LogOptions options;
  options.base_from_lidar = {0.3, 0.0, 0.1};
  const auto log = open_log(file, options);
  const auto scan = std::get<ScanRecord>(log->next().value());
  EXPECT_EQ(scan.scan.stamp, at(0.01));
  EXPECT_EQ(scan.scan.ranges_m, sample_scan({}).ranges_m);
  EXPECT_EQ(scan.scan.intensities, sample_scan({}).intensities);
  EXPECT_NEAR(scan.scan.angle_rad(2), -1.48, 1e-6);
  EXPECT_DOUBLE_EQ(scan.base_from_lidar.x_m(), 0.3);
  const auto odometry = std::get<OdometryReading>(log->next().value());
  EXPECT_NEAR(odometry.odom_from_base.yaw_rad(), 0.5, 1e-12);
  const auto cloud = std::get<CloudRecord>(log->next().value());
  EXPECT_EQ(cloud.cloud.points, sample_cloud({}).points);
  EXPECT_FALSE(log->next());
}

TEST(Bag, SeveralTopicsOfAKindMustBeChosenFrom) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "run.bag";
  {
    BagWriter writer(file);
    writer.write("/left", sample_scan(stamp_from_seconds(1.0)));
    writer.write("/right", sample_scan(stamp_from_seconds(2.0)));
    writer.close();
  }
  EXPECT_THAT(error_of(file), HasSubstr("/left, /right"));
  EXPECT_THAT(error_of(file), HasSubstr("--scan-topic"));
  LogOptions options;
  options.bag.scan_topic = "/right";
  EXPECT_EQ(to_seconds(stamp_of(*open_log(file, options)->next())), 2.0);
  options.bag.scan_topic = "/none";
  EXPECT_THAT(error_of(file, options), HasSubstr("has no topic /none"));
}

TEST(Bag, AnOrientationOfAnyLengthIsReadAndNoneIsRefused) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, double qz, double qw) {
    rosbag_bridge::Output output((folder.path() / name).string());
    rosbag_bridge::Pose pose;
    pose.stamp_ns = 5'000'000'000;
    pose.qz = qz, pose.qw = qw;
    output.write_odometry("/odom", pose);
    output.close();
    return folder.path() / name;
  };
  const auto log = open_log(write("long.bag", 2.0, 2.0));
  EXPECT_NEAR(std::get<OdometryReading>(log->next().value()).odom_from_base.yaw_rad(), kPi / 2.0, 1e-12);
  EXPECT_THAT(error_of(write("none.bag", 0.0, 0.0)), HasSubstr("no orientation"));
}

TEST(Bag, RefusesWhatIsNone) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(error_of(folder.write("a.bag", "no bag at all")), HasSubstr("no readable ROS 1 bag"));
  EXPECT_THAT(error_of(folder.write("b.bag", "")), HasSubstr("no readable ROS 1 bag"));
  const auto file = folder.path() / "c.bag";
  {
    BagWriter writer(file);
    writer.write("/cmd_vel", VelocityCommand{}, stamp_from_seconds(1.0));
    writer.close();
  }
  EXPECT_THAT(error_of(file), HasSubstr("or Odometry, but geometry_msgs/Twist"));
}

std::string std_string(const std::string& text) {
  return test::number_bytes(static_cast<std::uint32_t>(text.size())) + text;
}

/// All texts of a bag; what is wrong with it ends them.
std::string texts_of(const std::filesystem::path& file) {
  std::string all;
  rosbag_bridge::Input::Sinks sinks;
  sinks.text = [&](const std::string& topic, const std::string& text) { all += topic + " " + text + "\n"; };
  try {
    rosbag_bridge::Input input(file.string());
    input.choose({"/3"});
    while (input.next(sinks)) {
    }
  } catch (const std::runtime_error& e) {
    all += e.what();
  }
  return all;
}

TEST(Bag, IsReadHoweverItsChunksArePacked) {
  const test::TemporaryFolder folder;
  std::vector<test::MadeMessage> messages;
  std::string expected;
  for (const std::size_t size : {5U, 0U, 3'000'000U}) {
    messages.push_back({3, std_string(std::string(size, 'x'))});
    expected += "/3 " + std::string(size, 'x') + "\n";
  }
  for (const char* packing : {"none", "bz2"})
    EXPECT_EQ(texts_of(folder.write(packing, test::made_bag(messages, packing))), expected) << packing;
  {
    BagWriter writer(folder.path() / "lz4");
    for (std::size_t i = 0; i < messages.size(); ++i)
      writer.write("/3", messages[i].bytes.substr(4), stamp_from_seconds(1.0 + static_cast<double>(i)));
    writer.close();
  }
  EXPECT_EQ(texts_of(folder.path() / "lz4"), expected);
}

/// What a bag says of itself and what it is: no memory is asked for, and no byte read, that it does not have.
TEST(Bag, WhatLiesOutsideIsRefusedWithTheReason) {
  const test::TemporaryFolder folder;
  const std::string bag = test::made_bag({{3, std_string("first")}, {3, std_string("second")}}, "none");
  const auto said = [&](const std::string& before, std::uint32_t value, std::size_t times = 1) {
    std::string bytes = bag;
    std::size_t at = 0;
    for (; times > 0; --times) at = bytes.find(before, at) + before.size();
    bytes.replace(at, sizeof value, test::number_bytes(value));
    return texts_of(folder.write("a.bag", bytes));
  };
  EXPECT_THAT(said("size=", 1U << 31U), HasSubstr("larger than 256 MiB"));
  EXPECT_THAT(said("size=", 4), HasSubstr("damaged"));
  EXPECT_THAT(said("chunk_count=", 2), HasSubstr("too soon"));
  EXPECT_THAT(said("index_pos=", 0xFFFFFFF0U), HasSubstr("too soon"));
  EXPECT_THAT(said("index_pos=", 0), HasSubstr("no index"));
  const std::string second_at = test::number_bytes(2U) + test::number_bytes(0U);
  EXPECT_THAT(said(second_at, 0xFFFFFFF0U, 2), HasSubstr("outside its record"));
  EXPECT_THAT(said(second_at, 0, 2), HasSubstr("first\n/3 first"));
  const std::string first_bytes = test::number_bytes(1U) + test::number_bytes(0U) + test::number_bytes(9U);
  EXPECT_THAT(said(first_bytes, 0xFFFFFFFFU), HasSubstr("outside its record"));
  for (std::size_t length = 0; length < bag.size(); length += 7)
    EXPECT_THAT(texts_of(folder.write("a.bag", bag.substr(0, length))), Not(HasSubstr("second"))) << length;
}

/// Scans at 5 Hz, wheels at 10 Hz, the scans' clock ahead by `ahead_s` and by `drift` of the time.
std::filesystem::path bag_of_two_clocks(const test::TemporaryFolder& folder, double ahead_s, double drift) {
  const auto at = [](double seconds) { return stamp_from_seconds(1'700'000'000.0 + seconds); };
  BagWriter writer(folder.path() / "clocks.bag");
  for (int i = 0; i < 100; ++i) {
    const double time_s = 0.1 * i;
    writer.write("/wheels", OdometryReading{at(time_s), {}});
    if (i % 2 == 0) writer.write("/laser", sample_scan(at(time_s * (1.0 + drift) + ahead_s)), at(time_s));
  }
  writer.close();
  return folder.path() / "clocks.bag";
}

TEST(Bag, TopicsOfTwoClocksArePutOnThatOfTheOdometry) {
  const test::TemporaryFolder folder;
  for (const double ahead_s : {5.0, -5.0, -1'699'999'900.0, 0.1}) {
    LogOptions options;
    std::string told;
    options.remark = [&](const std::string& what) { told += what; };
    const auto log = open_log(bag_of_two_clocks(folder, ahead_s, 0.0), options);
    const bool corrected = std::abs(ahead_s) > 1.0;
    EXPECT_EQ(told.find("/laser and /wheels are stamped by two clocks") != std::string::npos, corrected)
        << ahead_s;
    int scans = 0;
    while (const auto record = log->next()) {
      if (!std::holds_alternative<ScanRecord>(*record)) continue;
      const double right_s = 1'700'000'000.0 + 0.2 * scans++ + (corrected ? 0.0 : ahead_s);
      EXPECT_NEAR(to_seconds(stamp_of(*record)), right_s, 1e-6) << ahead_s;
    }
    EXPECT_EQ(scans, 50);
  }
  EXPECT_THAT(error_of(bag_of_two_clocks(folder, 5.0, 0.5)), HasSubstr("and more or less"));
}

std::string laser_message(float range_min, float range_max, const std::vector<std::vector<float>>& echoes,
                          bool multi) {
  const auto numbers = [](const std::vector<float>& values) {
    std::string bytes = test::number_bytes(static_cast<std::uint32_t>(values.size()));
    for (const float value : values) bytes += test::number_bytes(value);
    return bytes;
  };
  std::string bytes =
      test::number_bytes(0U) + test::number_bytes(1U) + test::number_bytes(0U) + std_string("laser");
  for (const float value : {-1.0F, 1.0F, 0.5F, 0.0F, 0.1F, range_min, range_max})
    bytes += test::number_bytes(value);
  bytes += test::number_bytes(static_cast<std::uint32_t>(echoes.size()));
  for (const auto& beam : echoes) bytes += multi ? numbers(beam) : test::number_bytes(beam.front());
  return bytes + test::number_bytes(0U);
}

TEST(Bag, LimitsThatAreNotStatedAreNone) {
  const test::TemporaryFolder folder;
  for (const auto& [low, high] :
       {std::pair(0.1F, 0.0F), std::pair(std::nanf(""), 30.0F), std::pair(0.1F, std::nanf(""))}) {
    const auto file = folder.write(
        "a.bag", test::made_bag({{0, laser_message(low, high, {{1.0F}, {0.0F}, {2.5F}}, false)}}, "none"));
    const auto scan = std::get<ScanRecord>(open_log(file)->next().value()).scan;
    EXPECT_EQ(scan.ranges_m, (std::vector<float>{1.0F, LaserScan::kNoReturn, 2.5F}));
  }
}

TEST(Bag, OfSeveralEchoesTheFirstCounts) {
  const test::TemporaryFolder folder;
  const std::size_t type = std::size(rosbag_bridge::kMessageTypes) - 1;
  const auto file = folder.write(
      "a.bag",
      test::made_bag({{type, laser_message(0.1F, 30.0F, {{1.0F, 2.0F}, {}, {2.5F}}, true)}}, "none"));
  const auto scan = std::get<ScanRecord>(open_log(file)->next().value()).scan;
  EXPECT_EQ(scan.ranges_m, (std::vector<float>{1.0F, LaserScan::kNoReturn, 2.5F}));
}

TEST(PointCloud2, RefusesRowsAndFieldsOutsideItsData) {
  const rosbag_bridge::Cloud good = fields_from_cloud(sample_cloud({}));
  ASSERT_TRUE(cloud_from_fields(good));
  const auto broken = [&](auto change) {
    rosbag_bridge::Cloud cloud = good;
    change(cloud);
    return !cloud_from_fields(cloud).ok();
  };
  EXPECT_TRUE(broken([](auto& c) { c.data.pop_back(); }));
  EXPECT_TRUE(broken([](auto& c) { c.width += 1; }));
  EXPECT_TRUE(broken([](auto& c) { c.height = 0xFFFFFFFFU; }));
  EXPECT_TRUE(broken([](auto& c) { c.fields[0].offset = 0xFFFFFFFEU; }));
  EXPECT_TRUE(broken([](auto& c) { c.fields[2].name = "w"; }));
  EXPECT_TRUE(broken([](auto& c) { c.big_endian = true; }));
  EXPECT_FALSE(broken([](auto& c) { c.width = 0, c.height = 0xFFFFFFFFU; })) << "rows of nothing";
}

/// As velodyne_pointcloud stamps a revolution unless it is told otherwise: at its last packet.
TEST(PointCloud2, TimesBeforeItsStampAreOfASweepThatEndsThere) {
  PointCloud<Lidar> sent = sample_cloud(stamp_from_seconds(100.0));
  for (CloudPoint& p : sent.points) p.time_offset_s -= 0.1F;
  const auto got = cloud_from_fields(fields_from_cloud(sent));
  ASSERT_TRUE(got);
  EXPECT_NEAR(to_seconds(got.value().stamp), 99.9, 1e-6);
  for (std::size_t i = 0; i < sent.points.size(); ++i)
    ASSERT_NEAR(got.value().points[i].time_offset_s, 0.001 * static_cast<double>(i), 1e-6);
}

/// A capture of little-endian numbers, raw IPv4, with one UDP packet of each length.
std::string capture_of(const std::vector<std::size_t>& lengths) {
  std::string file;
  const auto put = [&file](std::uint32_t value, int bytes = 4) {
    for (int i = 0; i < bytes; ++i) file += static_cast<char>((value >> (8 * i)) & 0xFFU);
  };
  put(0xA1B2C3D4U), put(2, 2), put(4, 2), put(0), put(0), put(65'535), put(101);
  for (const std::size_t length : lengths) {
    const auto all = static_cast<std::uint32_t>(28 + length);
    put(1'000), put(0), put(all), put(all);
    std::string packet(all, '\0');
    packet[0] = 0x45, packet[9] = 17;
    packet[24] = static_cast<char>((8 + length) >> 8U), packet[25] = static_cast<char>((8 + length) & 0xFFU);
    file += packet;
  }
  return file;
}

int packets_of(const std::filesystem::path& file) {
  pcap::PcapReader reader(file);
  int packets = 0;
  while (reader.next()) ++packets;
  return packets;
}

TEST(Capture, OneThatWasCutShortEndsThereAndADamagedOneIsRefused) {
  const test::TemporaryFolder folder;
  const std::string good = capture_of(std::vector<std::size_t>{100, 200, 300});
  EXPECT_EQ(packets_of(folder.write("good.pcap", good)), 3);
  EXPECT_EQ(packets_of(folder.write("short.pcap", good.substr(0, good.size() - 10))), 2);
  std::string damaged = good;
  for (std::size_t i = 0; i < 4; ++i) damaged[24 + 16 + 128 + 8 + i] = '\xFF';  // the second one's length
  try {
    (void)packets_of(folder.write("damaged.pcap", damaged));
    FAIL() << "half a capture was taken for a whole one";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("is damaged after 1 packets"));
  }
}

/// What a made capture holds: a data packet as a VLP-16 sends it, and how to change it.
struct Sent {
  std::uint8_t product = 0x22, mode = 0x37, host = 201;
  std::size_t most_bytes = 65'535;  ///< of a frame, in the capture
  int order = 0;
};

std::string capture_of(const std::vector<Sent>& all) {
  std::string file;
  const auto put = [&file](std::size_t value, int bytes = 4) {
    for (int i = 0; i < bytes; ++i) file += static_cast<char>((value >> (8 * i)) & 0xFFU);
  };
  put(0xA1B2C3D4U), put(2, 2), put(4, 2), put(0), put(0), put(65'535), put(101);
  for (const Sent& sent : all) {
    vlp16::DataPacket packet;
    packet.time_us = 1'000U + 1'327U * static_cast<unsigned>(sent.order);
    for (std::size_t b = 0; b < vlp16::kBlocks; ++b)
      packet.blocks[b].azimuth_cdeg =
          static_cast<std::uint16_t>(40 * (12 * sent.order + static_cast<int>(b)));
    const auto bytes = vlp16::encode(packet);
    std::string frame(28, '\0');
    frame += std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    frame[0] = 0x45, frame[9] = 17;
    const std::array<std::uint8_t, 4> from{192, 168, 1, sent.host};
    for (std::size_t i = 0; i < from.size(); ++i) frame[12 + i] = static_cast<char>(from[i]);
    frame[24] = static_cast<char>(1214U >> 8U), frame[25] = static_cast<char>(1214U & 0xFFU);
    frame[28 + 1204] = static_cast<char>(sent.mode), frame[28 + 1205] = static_cast<char>(sent.product);
    const std::size_t kept = std::min(sent.most_bytes, frame.size());
    put(1'000), put(1'327U * static_cast<unsigned>(sent.order)), put(kept), put(frame.size());
    file += frame.substr(0, kept);
  }
  return file;
}

TEST(Capture, WhatIsNoVlp16IsRefusedByName) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::vector<Sent>& all) {
    return error_of(folder.write("a.pcap", capture_of(all)));
  };
  EXPECT_EQ(refused({{}, {.order = 1}}), "");
  EXPECT_THAT(refused({{.product = 0x24}, {.product = 0x24, .order = 1}}),
              HasSubstr("another sensor (Puck Hi-Res)"));
  EXPECT_THAT(refused({{.product = 0x28, .mode = 0x3A}}), HasSubstr("another sensor (VLP-32C)"));
  EXPECT_THAT(refused({{.product = 0xA1}}), HasSubstr("another sensor (VLS-128"));
  EXPECT_THAT(refused({{.mode = 0x3A}}), HasSubstr("unknown return mode (0x3A)"));
  EXPECT_THAT(refused({{.most_bytes = 96}, {.most_bytes = 96, .order = 1}}),
              AllOf(HasSubstr("the beginnings of 2 UDP packets only"), HasSubstr("tcpdump -s 0")));
  EXPECT_THAT(error_of(folder.write("b.pcap", capture_of(std::vector<std::size_t>{100, 200}))),
              HasSubstr("UDP port 2368"));
}

TEST(Capture, SeveralSensorsAreNamedAndToBeChosenFrom) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(
      error_of(folder.write("a.pcap", capture_of({Sent{}, Sent{.host = 202}}))),
      AllOf(HasSubstr("several VLP-16 (192.168.1.201, 192.168.1.202)"), HasSubstr("src host 192.168.1.201")));
  EXPECT_EQ(error_of(folder.write("b.pcap", capture_of({Sent{}, Sent{.product = 0x24, .host = 202}}))), "")
      << "another model beside it is not mixed in";
}

TEST(OpenLog, NamesTheMend) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(error_of("/nonexistent.log"), HasSubstr("is no file"));
  EXPECT_THAT(error_of(folder.write("a.txt", "x")), HasSubstr(".pcap (VLP-16)"));
  EXPECT_THAT(error_of(folder.write("a.pcap", "x")), HasSubstr("is no packet capture"));
  LogOptions options;
  options.wheels = "wheels.csv";
  EXPECT_THAT(error_of(folder.write("a.log", ""), options), HasSubstr("carries its own odometry"));
}

TEST(OpenLog, RefusesAnotherSensorsCapture) {
  const auto file = std::filesystem::path(MADORI_SHARED_DATA) / "vlp16/not_vlp16_hdl32.pcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  EXPECT_THAT(error_of(file), HasSubstr("HDL-32E"));
}

TEST(OpenLog, MergesACaptureWithItsWheels) {
  const auto file = std::filesystem::path(MADORI_SHARED_DATA) / "vlp16/vlp-16-test-90deg-1-50-frames.pcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  const test::TemporaryFolder folder;
  std::string csv = "time_s,left_rad,right_rad\n";
  for (int i = 0; i < 400; ++i)
    csv += std::to_string(1415069209.0 + 0.01 * i) + "," + std::to_string(0.1 * i) + "," +
           std::to_string(0.1 * i) + "\n";
  LogOptions options;
  options.wheels = folder.write("wheels.csv", csv);
  const auto log = open_log(file, options);
  int clouds = 0, readings = 0;
  Stamp last{};
  while (const auto record = log->next()) {
    EXPECT_GE(stamp_of(*record), last);
    last = stamp_of(*record);
    ++(std::holds_alternative<CloudRecord>(*record) ? clouds : readings);
  }
  EXPECT_EQ(clouds, 52);
  EXPECT_EQ(readings, 400);
  options.wheels = folder.write("late.csv", "time_s,left_rad,right_rad\n1500000000,0,0\n");
  EXPECT_THAT(error_of(file, options), HasSubstr("on the clock of the capture"));
  options.wheels = folder.write("since_power_up.csv", "time_s,left_rad,right_rad\n0,0,0\n600,1,1\n");
  EXPECT_THAT(error_of(file, options), HasSubstr("ends before the capture begins"));
  options.wheels = folder.write("bad.csv", "time_s,left_rad,right_rad\n1415069209,0,nan\n");
  EXPECT_THAT(error_of(file, options), HasSubstr("bad.csv:2"));
  options.wheels = folder.write("back.csv", "time_s,left_rad,right_rad\n1415069209,0,0\n1415069208,0,0\n");
  EXPECT_THAT(error_of(file, options), HasSubstr("back.csv:3"));
}

TEST(Bag, ARevolutionIsDeskewedByTheOdometryBesideIt) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "run.bag";
  const auto at = [](double seconds) { return stamp_from_seconds(1'700'000'000.0 + seconds); };
  const Transform2<Base, Lidar> base_from_lidar(0.2, 0.0, 0.0);
  const auto pose_at = [](double t) { return Transform2<Odom, Base>(1.0 * t, 0.0, 0.5 * t); };
  const Point2<Odom> post{5.0, 1.0};
  {
    BagWriter writer(file);
    PointCloud<Lidar> cloud{at(0.2), {}};  // stamped at its end, as velodyne_pointcloud does
    for (int i = 0; i <= 10; ++i) {
      const auto seen = (pose_at(0.1 + 0.01 * i) * base_from_lidar).inverse() * post;
      cloud.points.push_back({static_cast<float>(seen.x_m), static_cast<float>(seen.y_m), 0.5F,
                              -0.1F + 0.01F * static_cast<float>(i)});
    }
    for (int i = 0; i < 20; ++i) writer.write("/odom", OdometryReading{at(0.02 * i), pose_at(0.02 * i)});
    writer.write("/points", cloud);
    for (int i = 20; i < 40; ++i) writer.write("/odom", OdometryReading{at(0.02 * i), pose_at(0.02 * i)});
    writer.close();
  }
  LogOptions options;
  options.base_from_lidar = base_from_lidar;
  const auto log = open_log(file, options);
  const auto first = (pose_at(0.1) * base_from_lidar).inverse() * post;
  int clouds = 0;
  Stamp last{};
  while (const auto record = log->next()) {
    EXPECT_GE(stamp_of(*record), last);
    last = stamp_of(*record);
    const auto* cloud = std::get_if<CloudRecord>(&*record);
    if (cloud == nullptr) continue;
    ++clouds;
    EXPECT_NEAR(to_seconds(cloud->cloud.stamp - at(0.1)), 0.0, 1e-6);
    for (const CloudPoint& p : cloud->cloud.points) {
      EXPECT_NEAR(p.x_m, first.x_m, 1e-3);
      EXPECT_NEAR(p.y_m, first.y_m, 1e-3);
    }
  }
  EXPECT_EQ(clouds, 1);
}

/// A lidar of 40 Hz that turns with its vehicle before a wall 3 m ahead of where it began.
TEST(Bag, AScanWhoseBeamsHaveAPeriodIsDeskewedAsACloudIs) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "run.bag";
  const auto at = [](double seconds) { return stamp_from_seconds(1'700'000'000.0 + seconds); };
  constexpr double kTurnRadps = 1.5, kBeamS = 0.0001;
  LaserScan scan{at(0.1), duration_from_seconds(kBeamS), -0.5, 0.005, 30.0, {}, {}};
  for (int i = 0; i < 200; ++i)
    scan.ranges_m.push_back(static_cast<float>(
        3.0 / std::cos(scan.angle_rad(static_cast<std::size_t>(i)) + kTurnRadps * (0.1 + kBeamS * i))));
  const auto write = [&](Duration beam_period) {
    BagWriter writer(file);
    scan.beam_period = beam_period;
    writer.write("/scan", scan);
    for (int i = 0; i < 40; ++i)
      writer.write("/odom", OdometryReading{at(0.02 * i), {0.0, 0.0, kTurnRadps * 0.02 * i}});
    writer.close();
  };
  const auto read = [&] {
    const auto log = open_log(file);
    for (auto record = log->next(); record; record = log->next())
      if (const auto* found = std::get_if<ScanRecord>(&*record)) return *found;
    throw Error(file.string(), "holds no scan", "");
  };
  write(duration_from_seconds(kBeamS));
  const ScanRecord record = read();
  ASSERT_TRUE(record.moved);
  ASSERT_EQ(record.moved->points.size(), scan.ranges_m.size());
  const Transform2<Odom, Lidar> begin(0.0, 0.0, kTurnRadps * 0.1);
  for (const CloudPoint& p : record.moved->points)
    EXPECT_NEAR((begin * Point2<Lidar>{p.x_m, p.y_m}).x_m, 3.0, 1e-3);
  write(Duration(0));
  EXPECT_FALSE(read().moved);
  write(duration_from_seconds(0.1));  // a driver that states the whole sweep's time
  EXPECT_FALSE(read().moved);
}

TEST(WhichLidar, IsToldByFramePlaceOrKind) {
  const std::vector<MountedLidar> three{{"roof", "roof", 0, false, {}, 1.2},
                                        {"front", "front", 1, true, {}, 0.2},
                                        {"rear", "rear", 2, true, {}, 0.2}};
  const auto name = [](const std::vector<MountedLidar>& lidars, bool planar, const char* topic,
                       const char* frame) {
    const MountedLidar* const found = which_lidar(lidars, planar, topic, frame);
    return found == nullptr ? "?" : found->name;
  };
  EXPECT_EQ(name(three, true, "/scan", "/rear"), "rear");
  EXPECT_EQ(name(three, true, "/scan/1", "laser"), "front");
  EXPECT_EQ(name(three, true, "/scan/2", "laser"), "rear");
  EXPECT_EQ(name(three, true, "/scan/7", "laser"), "?");
  EXPECT_EQ(name(three, true, "/base_scan", "laser"), "?");
  EXPECT_EQ(name(three, false, "/points", "velodyne"), "roof");
  EXPECT_EQ(name(three, true, "/cut_out_of_the_cloud", "roof"), "roof");
  const std::vector<MountedLidar> two{three[0], three[1]};
  EXPECT_EQ(name(two, true, "/scan", "laser"), "front");
  EXPECT_EQ(name({three[0]}, true, "/scan", "laser"), "roof");
  EXPECT_EQ(name({}, true, "/scan", "laser"), "?");
}

TEST(Bag, EachTopicHasTheMountingOfItsOwnLidar) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "run.bag";
  {
    BagWriter writer(file);
    writer.write("/base_scan", sample_scan(stamp_from_seconds(1.0)));
    writer.write("/points", sample_cloud(stamp_from_seconds(1.1)));
    writer.close();
  }
  LogOptions options;
  options.bag.lidars = {{"roof", "roof", 0, false, {0.3, 0.0, kPi}, 1.2},
                        {"front", "front", 1, true, {0.5, 0.0, 0.0}, 0.2}};
  const auto log = open_log(file, options);
  const auto scan = std::get<ScanRecord>(log->next().value());
  EXPECT_DOUBLE_EQ(scan.base_from_lidar.x_m(), 0.5);
  EXPECT_EQ(scan.scan.lidar, 1U);
  const auto cloud = std::get<CloudRecord>(log->next().value());
  EXPECT_DOUBLE_EQ(cloud.lidar_height_m, 1.2);
  options.bag.lidars.push_back({"rear", "rear", 2, true, {}, 0.2});
  EXPECT_THAT(error_of(file, options),
              HasSubstr("/base_scan: may be of each of the site's lidars: roof, front, rear"));
}

TEST(Deskew, StraightensAWallThatWasSeenWhileTurningAndDriving) {
  const Transform2<Base, Lidar> base_from_lidar(0.2, 0.1, 0.3);
  OdometryTrack track;
  const auto pose_at = [](double t) { return Transform2<Odom, Base>(1.0 * t, 0.2 * t, 1.5 * t); };
  for (int i = -2; i < 15; ++i) track.add({stamp_from_seconds(100.0 + 0.01 * i), pose_at(0.01 * i)});
  PointCloud<Lidar> cloud{stamp_from_seconds(100.0), {}}, still = cloud;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.0001 * i;
    const Point2<Odom> wall{30.0, -20.0 + 0.04 * i};
    const auto seen = (pose_at(t) * base_from_lidar).inverse() * wall;
    const auto truth = (pose_at(0.0) * base_from_lidar).inverse() * wall;
    cloud.points.push_back(
        {static_cast<float>(seen.x_m), static_cast<float>(seen.y_m), 1.0F, static_cast<float>(t)});
    still.points.push_back(
        {static_cast<float>(truth.x_m), static_cast<float>(truth.y_m), 1.0F, static_cast<float>(t)});
  }
  ASSERT_TRUE(deskew(cloud, base_from_lidar, track));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    ASSERT_NEAR(cloud.points[i].x_m, still.points[i].x_m, 1e-3) << i;
    ASSERT_NEAR(cloud.points[i].y_m, still.points[i].y_m, 1e-3) << i;
  }
  PointCloud<Lidar> later = still;
  later.stamp += std::chrono::seconds(1);
  EXPECT_FALSE(deskew(later, base_from_lidar, track));
  EXPECT_EQ(later.points, still.points);
}

}  // namespace
}  // namespace madori::sensors
