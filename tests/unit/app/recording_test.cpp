#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/mounting/mounting_log.hpp"
#include "app/recording/input_text.hpp"
#include "app/recording/recorder.hpp"
#include "app/recording/replay.hpp"
#include "core/result.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "sensors/lidar/registry.hpp"
#include "sensors/vlp16/encode.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

/// A pose from the wheels alone, begun at the origin: the same in the run and in its replay.
class WheelPose final : public PoseSource {
 public:
  PoseEstimate on_odometry(const OdometryReading& r) override {
    const auto& p = r.odom_from_base;
    return {r.stamp,
            {p.x_m(), p.y_m(), p.yaw_rad()},
            Eigen::Matrix3d::Identity() * 1e-4,
            {LocalizationState::Localized, ""}};
  }
  void on_cloud(const PointCloud<Base>& /*cloud*/, const Transform2<Odom, Base>& /*odom*/) override {}
  void set_pose(const Transform2<Map, Base>& /*pose*/, const PoseSigma& /*sigma*/) override {}
  void search_anew() override {}
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return {}; }
};

CycleConfig config() {
  return test::toy_config(planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,12,0\n").graph);
}

/// Drives past a pallet, with a silent lidar for a while, and records every step.
void record_run(const fs::path& folder, const RecorderOptions& options) {
  test::ToyVehicle vehicle(config(), {0.0, 0.0, 0.0});
  vehicle.lidar.azimuths = 180;
  vehicle.lidar.bodies.push_back({{{6.0, -0.3}, {6.0, 0.3}}, 0.3, 0.4});
  vehicle.set_source(std::make_unique<WheelPose>());
  Recorder recorder(folder, options);
  vehicle.on_step = [&](const CycleInput& in, const CycleOutput& out, const CycleState& s) {
    recorder.add(in, out, s);
  };
  vehicle.each_step = [&] { vehicle.lidar_silent = vehicle.time_s() > 4.0 && vehicle.time_s() < 5.5; };
  vehicle.drive_to({{1, StopAction::Unload, 0.5}});
  vehicle.say(OperatorWord::Resume);
  ASSERT_TRUE(vehicle.run_until([&] { return vehicle.delivered(); }, 90.0));
}

TEST(InputText, ComesBackToTheLastBit) {
  CycleInput input;
  input.now = stamp_from_seconds(1.7e9 + 0.123456789);
  input.drive.push_back(
      {.sequence = 7, .faults = 3, .time_us = 123, .left_angle = 16383, .battery_mv = 25'000});
  input.thinking = true;
  input.protective_stop = true;
  input.commands.push_back({OperatorWord::Jog, {0.1, -1.0 / 3.0}});
  input.commands.push_back({OperatorWord::SetPose, {}, {{1.0 / 3.0, -7.1}, 1.0 / 7.0, {0.3, 0.1}}});
  input.order = Order{5, {{3, StopAction::Load, 0.1}}, 2, OrderState::Running, 1, 0, "note"};
  input.detour = planning::DetourAnswer{9, Path{{PathPoint{{1.0 / 3.0, 2.0}, -0.1, 0.2}}}, 1, "why"};
  const CycleInput back = input_from_text(input_text(input));
  EXPECT_EQ(back.now, input.now);
  ASSERT_EQ(back.drive.size(), 1U);
  EXPECT_EQ(back.drive[0].left_angle, 16383);
  EXPECT_TRUE(back.thinking);
  EXPECT_TRUE(back.protective_stop);
  EXPECT_EQ(back.commands[0].jog, input.commands[0].jog);
  EXPECT_EQ(back.commands[1].given_pose, input.commands[1].given_pose);
  EXPECT_EQ(back.order, input.order);
  ASSERT_TRUE(back.detour && back.detour->path);
  EXPECT_EQ(back.detour->path->points[0].position, input.detour->path->points[0].position);
  EXPECT_EQ(back.detour->path->points[0].speed_limit_mps, std::numeric_limits<double>::infinity());
  EXPECT_THROW((void)input_from_text("{"), Error);
  EXPECT_THROW((void)input_from_text("{\"now\": \"never\"}"), Error);
}

TEST(Recording, AReplayedRunGivesTheSameCommandsBitForBit) {
  const test::TemporaryFolder folder;
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 8.0;
  record_run(folder.path() / "run", options);
  EXPECT_TRUE(fs::exists(folder.path() / "run/001.bag")) << "bags rotate";
  const auto result = replay(folder.path() / "run", config(), std::make_unique<WheelPose>());
  EXPECT_GT(result.steps, 500U);
  EXPECT_EQ(result.different, 0U) << "first at step " << result.first_different;

  CycleConfig other = config();
  other.pursuit.look_ahead_s = 0.9;
  EXPECT_GT(replay(folder.path() / "run", other, std::make_unique<WheelPose>()).different, 10U)
      << "a replay with other settings must show";
}

TEST(Recording, HandsOutWhatReachedTheCycle) {
  const test::TemporaryFolder folder;
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 8.0;
  record_run(folder.path() / "run", options);
  std::size_t clouds = 0, steps = 0;
  MountingLog log(config().odometry.wheels);
  look_at_inputs(folder.path() / "run", config(), [&](const CycleInput& input) {
    clouds += input.clouds.size();
    ++steps;
    log.add(input);
  });
  EXPECT_GT(steps, 500U);
  EXPECT_GT(clouds, steps / 6);
  const localization::WheelPath path(log.drive().wheels, config().odometry.wheels);
  EXPECT_NEAR(path.driven_m(), 12.0, 1.0) << "the wheels as the calibration of the mountings takes them";
  EXPECT_GT(log.drive().sweeps.size(), 40U);
}

/// Packets of a VLP-16 around which everything stands equally far away.
class RoundRoom {
 public:
  explicit RoundRoom(std::uint16_t distance) : distance_(distance) {}
  sensors::RawPacket next(std::size_t lidar, Stamp now) {
    sensors::vlp16::DataPacket packet;
    packet.time_us = static_cast<std::uint32_t>(time_us_);
    time_us_ += sensors::vlp16::packet_us(packet.mode);
    for (auto& block : packet.blocks) {
      block.azimuth_cdeg = std::exchange(azimuth_cdeg_, (azimuth_cdeg_ + 40) % 36'000);
      block.returns.fill({distance_, 7});
    }
    const auto bytes = encode(packet);
    return {now, {bytes.begin(), bytes.end()}, lidar};
  }

 private:
  std::uint16_t distance_;
  std::uint16_t azimuth_cdeg_ = 0;
  double time_us_ = 1e6;
};

TEST(Recording, EachOfTwoSpinningLidarsKeepsItsOwnPackets) {
  const test::TemporaryFolder folder;
  CycleConfig two = config();
  two.lidars.front().type = "vlp16";
  two.lidars.push_back(two.lidars.front());
  two.lidars.back().name = "rear";
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.lidars = two.lidars;
  std::vector<PointCloud<Lidar>> seen, back;
  {
    Recorder recorder(folder.path() / "run", options);
    std::array<RoundRoom, 2> rooms{RoundRoom(1000), RoundRoom(2000)};
    std::array<std::unique_ptr<sensors::LidarDecoder>, 2> decoders;
    CycleInput input;
    for (std::size_t i = 0; i < 2; ++i)
      decoders[i] = sensors::find_lidar("vlp16")->decoder({}, [&input, i](sensors::LidarSweep& sweep) {
        input.clouds.push_back(std::move(std::get<PointCloud<Lidar>>(sweep.seen)));
        input.clouds.back().lidar = i;
        input.firings_us.push_back(sweep.device_us);
      });
    const CycleState state(two, std::make_unique<WheelPose>());
    for (int k = 0; k < 60; ++k) {
      input = {};
      input.now = stamp_from_seconds(1.7e9 + 0.01 * k);
      for (int packet = 0; packet < 8; ++packet)
        for (std::size_t i = 0; i < 2; ++i) {
          input.packets.push_back(rooms[i].next(i, input.now));
          decoders[i]->push(input.packets.back().bytes, input.now);
        }
      seen.insert(seen.end(), input.clouds.begin(), input.clouds.end());
      recorder.add(input, {}, state);
    }
  }
  look_at_inputs(folder.path() / "run", two, [&](const CycleInput& input) {
    back.insert(back.end(), input.clouds.begin(), input.clouds.end());
  });
  ASSERT_GE(seen.size(), 8U);
  ASSERT_EQ(back.size(), seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(back[i].lidar, seen[i].lidar);
    ASSERT_EQ(back[i].points.size(), seen[i].points.size());
    EXPECT_EQ(back[i].points.front().x_m, seen[i].points.front().x_m);
  }
}

TEST(Recording, TheSizeLimitHoldsAndStopsAreKept) {
  const test::TemporaryFolder folder;
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 3.0;
  options.room.max_bytes = 1;
  record_run(folder.path() / "run", options);
  EXPECT_FALSE(fs::exists(folder.path() / "run/000.bag")) << "the oldest has made room";
  std::size_t bags = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "run"))
    bags += entry.path().extension() == ".bag";
  EXPECT_EQ(bags, 2U);
  EXPECT_TRUE(fs::exists(folder.path() / "run/stops")) << "the vehicle stopped while the lidar was silent";
}

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.push_back(fs::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Three runs with bags of 10 bytes, older by an hour each, the last at hand.
void lay_out_runs(const test::TemporaryFolder& folder) {
  const auto now = fs::file_time_type::clock::now();
  int hours = 10;
  for (const char* name : {"runs/a/000.bag", "runs/a/stops/000.bag", "runs/b/000.bag", "runs/b/stops/000.bag",
                           "runs/c/000.bag", "runs/c/001.bag", "runs/c/002.bag", "runs/notes.txt"}) {
    fs::create_directories((folder.path() / name).parent_path());
    folder.write(name, "0123456789");
    fs::last_write_time(folder.path() / name, now - std::chrono::hours(hours--));
  }
}

/// A disk that takes no more than 20 kB a file for a while, as a full one: neither the steps nor the end of
/// the program are disturbed, and once there is room again the recording goes on and can be replayed.
TEST(Recording, AFullDiskEndsABagAndNotTheProgram) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto limit_files = [](rlim_t bytes) {
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  };
  const auto life = [&](bool room_again) {
    const test::TemporaryFolder folder;
    std::signal(SIGXFSZ, SIG_IGN);
    limit_files(20'000);
    std::uint64_t lost = 0;
    {
      Recorder recorder(folder.path(), {.segment_s = 1.0, .room = {}, .max_waiting = 100'000});
      test::ToyVehicle vehicle(config(), {0.0, 0.0, 0.0});
      vehicle.set_source(std::make_unique<WheelPose>());
      vehicle.on_step = [&](const auto& in, const auto& out, const auto& s) { recorder.add(in, out, s); };
      vehicle.run_until([] { return false; }, 4.0);
      while (recorder.problem().empty()) std::this_thread::yield();
      if (room_again) limit_files(RLIM_INFINITY);
      vehicle.run_until([] { return false; }, 4.0);
      lost = recorder.lost();
    }
    limit_files(RLIM_INFINITY);
    if (lost == 0) std::_Exit(1);
    if (room_again && replay(folder.path(), config(), std::make_unique<WheelPose>()).steps < 50)
      std::_Exit(2);
    std::_Exit(0);
  };
  EXPECT_EXIT(life(false), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(life(true), testing::ExitedWithCode(0), "");
}

TEST(Recording, AllRunsShareTheLimitAndTheOldestGo) {
  using Names = std::vector<std::string>;
  const test::TemporaryFolder folder;
  lay_out_runs(folder);
  const fs::path runs = folder.path() / "runs";
  make_room(runs / "c", {50, 20, 0});
  EXPECT_EQ(files_below(runs).size(), 13U) << "nothing goes within the limits";
  make_room(runs / "c", {30, 10, 0});
  EXPECT_EQ(files_below(runs), (Names{"b", "b/stops", "b/stops/000.bag", "c", "c/000.bag", "c/001.bag",
                                      "c/002.bag", "notes.txt"}));
  make_room(runs / "c", {1000, 1000, std::numeric_limits<std::uintmax_t>::max()});
  EXPECT_EQ(files_below(runs), (Names{"c", "c/001.bag", "c/002.bag", "notes.txt"})) << "the disk is full";
}

/// 999.bag was written before the time of day was set back by hours, and a run before by a clock ahead of it.
TEST(Recording, WhatIsRecordedNowIsTheNewestWhateverTheClockSaid) {
  const test::TemporaryFolder folder;
  const fs::path runs = folder.path() / "runs", now = runs / "now";
  const auto write = [&](const fs::path& bag, int hours) {
    fs::create_directories(bag.parent_path());
    folder.write(bag, "0123456789");
    fs::last_write_time(bag, fs::file_time_type::clock::now() + std::chrono::hours(hours));
  };
  write(runs / "before" / "000.bag", 20);
  write(runs / "before" / "stops" / "000.bag", 20);
  for (const fs::path& of : {now, now / "stops"}) {
    write(of / "998.bag.active", 9);
    write(of / "999.bag", 10);
    write(of / "1000.bag", 1);
    write(of / "1001.bag", 2);
  }
  make_room(now, {20, 30, 0});
  EXPECT_EQ(files_below(runs),
            (std::vector<std::string>{"now", "now/1000.bag", "now/1001.bag", "now/stops",
                                      "now/stops/1000.bag", "now/stops/1001.bag", "now/stops/999.bag"}));
}

TEST(Recording, ARunWithoutBagsLeavesNothing) {
  const test::TemporaryFolder folder;
  lay_out_runs(folder);
  for (const char* run : {"a", "b", "c"})
    folder.write(std::string("runs/") + run + "/memory.bin", "what it began with");
  folder.write("runs/b/000.bag.active", "x");
  make_room(folder.path() / "runs/c", {31, 0, 0});
  EXPECT_EQ(files_below(folder.path() / "runs"),
            (std::vector<std::string>{"b", "b/000.bag.active", "b/memory.bin", "c", "c/000.bag", "c/001.bag",
                                      "c/002.bag", "c/memory.bin", "notes.txt"}));
}

TEST(Recording, TwoRunsOfTheSameSecondHaveTwoFolders) {
  const test::TemporaryFolder folder;
  std::vector<fs::path> runs;
  for (int i = 0; i < 4; ++i) {
    runs.push_back(new_run(folder.path()));
    EXPECT_FALSE(fs::exists(runs.back())) << "another run's bags would be overwritten";
    fs::create_directories(runs.back());
  }
  EXPECT_TRUE(std::is_sorted(runs.begin(), runs.end())) << "the panel lists them by their names";
}

/// Nothing can be kept around a stop, and among the runs lies what is no bag: no step is lost for that.
TEST(Recording, WhatCannotBeTidiedCostsNoSteps) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.path() / "runs/earlier/unpacked.bag");
  fs::create_directories(folder.path() / "runs/now");
  folder.write("runs/now/stops", "a file where a folder is to be");
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 1.0;
  record_run(folder.path() / "runs/now", options);
  const auto result = replay(folder.path() / "runs/now", config(), std::make_unique<WheelPose>());
  EXPECT_FALSE(result.recorded_poses) << "no bag is missing";
  EXPECT_EQ(result.different, 0U) << "first at step " << result.first_different;
  EXPECT_GT(result.steps, 500U);
}

TEST(Recording, AFolderThatIsGoneIsSaid) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(make_room(folder.path() / "runs/c", {50, 20, 0}), Error);
}

TEST(Recording, OutsideOfAFolderOfRunsNothingElseIsTouched) {
  const test::TemporaryFolder folder;
  folder.write("other.bag", "x");
  fs::create_directories(folder.path() / "run");
  folder.write("run/000.bag", "x");
  make_room(folder.path() / "run", {0, 0, std::numeric_limits<std::uintmax_t>::max()});
  EXPECT_TRUE(fs::exists(folder.path() / "other.bag"));
  EXPECT_TRUE(fs::exists(folder.path() / "run/000.bag"));
}

/// After 8 h a number has four digits.
TEST(Recording, AThousandBagsReplayInTheirOrder) {
  const test::TemporaryFolder folder;
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 5.0;
  const fs::path run = folder.path() / "run";
  record_run(run, options);
  fs::remove_all(run / "stops");
  int bags = 0;
  while (fs::exists(run / ("00" + std::to_string(bags) + ".bag"))) ++bags;
  ASSERT_GT(bags, 4);
  ASSERT_LT(bags, 10);
  for (int i = 0; i < bags; ++i)
    fs::rename(run / ("00" + std::to_string(i) + ".bag"), run / (std::to_string(998 + i) + ".bag"));
  fs::remove(run / "998.bag");  // it had to make room
  std::vector<Stamp> times;
  look_at_inputs(run, config(), [&](const CycleInput& input) { times.push_back(input.now); });
  EXPECT_GT(times.size(), 400U);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  const auto result = replay(run, config(), std::make_unique<WheelPose>());
  EXPECT_EQ(result.different, 0U) << "first at step " << result.first_different;
  EXPECT_NEAR(result.recorded_s, to_seconds(times.back() - times.front()), 1e-9);
}

TEST(Recording, ACutOutReplaysBitForBit) {
  const test::TemporaryFolder folder;
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 1.0;
  record_run(folder.path() / "run", options);
  const auto stops = folder.path() / "run/stops";
  ASSERT_FALSE(fs::exists(stops / "000.bag")) << "the stop was later";
  const auto result = replay(stops, config(), std::make_unique<WheelPose>());
  EXPECT_TRUE(result.recorded_poses);
  EXPECT_GE(result.steps, 95U);
  EXPECT_EQ(result.different, 0U) << "first at step " << result.first_different;
  const auto last = replay(folder.path() / "run/003.bag", config(), std::make_unique<WheelPose>());
  EXPECT_EQ(last.different, 0U) << "first at step " << last.first_different;
  CycleConfig other = config();
  other.pursuit.speed.max_speed_mps = 0.3;
  EXPECT_GT(replay(stops, other, std::make_unique<WheelPose>()).different, 10U);
}

/// A planar lidar's scan that ends at `now`.
LaserScan some_scan(std::size_t lidar, Stamp now) {
  LaserScan scan;
  scan.stamp = now - std::chrono::milliseconds(15);
  scan.angle_min_rad = -2.0;
  scan.angle_step_rad = 0.01;
  scan.range_max_m = 20.0;
  scan.beam_period = std::chrono::microseconds(27);
  scan.ranges_m.assign(401, 3.0F + static_cast<float>(lidar));
  scan.lidar = lidar;
  return scan;
}

/// Two planar lidars beside what the toy vehicle sees with; read by Debian's python3-rosbag.
TEST(Recording, RosToolsReadScansCommandsAndFrames) {
  const test::TemporaryFolder folder;
  RecorderOptions options;
  options.max_waiting = 1'000'000;
  options.segment_s = 4.0;
  options.lidars = {config().lidars.front(), config().lidars.front()};
  options.lidars[0].name = "front left";
  options.lidars[0].mounting = {0.7, 0.25, 0.15, 0.8};
  options.lidars[1].name = "rear";
  {
    Recorder recorder(folder.path(), options);
    test::ToyVehicle vehicle(config(), {0.0, 0.0, 0.0});
    vehicle.set_source(std::make_unique<WheelPose>());
    vehicle.on_step = [&](CycleInput in, const CycleOutput& out, const CycleState& s) {
      in.scans = {some_scan(0, in.now), some_scan(1, in.now)};
      recorder.add(in, out, s);
    };
    vehicle.drive_to({{1, StopAction::Unload, 0.5}});
    vehicle.say(OperatorWord::Resume);
    vehicle.run_until([&] { return vehicle.delivered(); }, 10.0);
  }
  const std::string command = "/usr/bin/python3 " MADORI_SOURCE_DIR "/tests/unit/app/read_bag.py " +
                              folder.path().string() + " front_left rear";
  const int status = std::system(command.c_str());
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "python3-rosbag is not installed";
  EXPECT_EQ(status, 0) << command;
}

TEST(Recording, WhatIsNoRecordingIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)replay(folder.path(), config(), std::make_unique<WheelPose>()), Error);
  folder.write("000.bag", "no bag");
  EXPECT_THROW((void)replay(folder.path(), config(), std::make_unique<WheelPose>()), Error);
}

}  // namespace
}  // namespace madori::app
