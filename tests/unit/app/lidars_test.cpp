#include "app/lidars.hpp"

#include <gtest/gtest.h>

#include "app/cycle/recoveries.hpp"
#include "app/cycle/site_config.hpp"
#include "app/cycle/stages.hpp"
#include "app/panel/found_devices.hpp"
#include "app/runner/socket_link.hpp"
#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

mapping::Site site_with(std::vector<mapping::SensorRecord> sensors) {
  mapping::Site site;
  site.sensors = std::move(sensors);
  return site;
}

std::string refusal_of(std::vector<mapping::SensorRecord> sensors) {
  try {
    (void)lidars_of(site_with(std::move(sensors)), "hall");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

const mapping::SensorRecord kTop{"top", "vlp16", 0.3, 0.0, 1.6, 0.0};
const mapping::SensorRecord kFront{"front", "lms1xx", 0.75, 0.0, 0.25, 0.0};
const mapping::SensorRecord kLeft{"left", "s300", 0.7, 0.25, 0.15, 45.0};

TEST(Lidars, AreMadeOfDataSheetAndMounting) {
  auto fine = kFront;
  fine.settings["rate_hz"] = "25";
  const auto lidars = lidars_of(site_with({kTop, fine, kLeft}), "hall");
  ASSERT_EQ(lidars.size(), 3U);
  EXPECT_EQ(lidars[0].kind, LidarKind::Spinning);
  EXPECT_DOUBLE_EQ(lidars[0].mounting.z_m, 1.6);
  EXPECT_DOUBLE_EQ(lidars[0].max_elevation_rad, to_rad(15.0));
  EXPECT_EQ(lidars[1].kind, LidarKind::Planar);
  EXPECT_DOUBLE_EQ(lidars[1].step_rad, to_rad(0.25));
  EXPECT_DOUBLE_EQ(lidars[1].period_s, 0.04);
  EXPECT_DOUBLE_EQ(lidars[2].mounting.yaw_rad, to_rad(45.0));
}

TEST(Lidars, SureRangesAreThoseOfTheSource) {
  auto fine = kFront;
  fine.settings["rate_hz"] = "25";
  // The standing body of 70 mm: 2.6 m at 0.5 deg, 3.2 m at 0.25 deg; the one of 200 mm: 8.1 and 9.9 m.
  EXPECT_NEAR(lidar_model(kFront).sure_range_m(0.07), 2.61, 0.01);
  EXPECT_NEAR(lidar_model(fine).sure_range_m(0.07), 3.20, 0.01);
  EXPECT_NEAR(lidar_model(kFront).sure_range_m(0.2), 8.09, 0.01);
  EXPECT_NEAR(lidar_model(fine).sure_range_m(0.2), 9.91, 0.01);
}

/// Also of the only one: it would be found out when the vehicle is to drive.
TEST(Lidars, APortThatIsNoneIsRefusedWithTheSite) {
  for (const char* address : {"0.0.0.0:70000", ":65536", "10.0.0.9:-1", "10.0.0.9:"}) {
    auto top = kTop;
    top.address = address;
    const std::string said = refusal_of({top});
    EXPECT_NE(said.find("sensor top"), std::string::npos) << said;
    EXPECT_NE(said.find(address), std::string::npos) << said;
  }
  auto top = kTop;
  top.address = ":65535";
  EXPECT_EQ(refusal_of({top}), "");
}

TEST(Lidars, WhatCannotBeIsRefusedInOneSentence) {
  EXPECT_NE(refusal_of({}).find("names no lidar"), std::string::npos);
  auto unknown = kTop;
  unknown.type = "hdl64";
  EXPECT_NE(refusal_of({unknown}).find("\"hdl64\" is no known sensor - use vlp16, lms1xx or s300"),
            std::string::npos)
      << refusal_of({unknown});
  auto outside = kFront;
  outside.x_m = 2.0;
  EXPECT_NE(refusal_of({outside}).find("front is mounted outside the vehicle"), std::string::npos);
  auto sunk = kFront;
  sunk.z_m = 0.0;
  EXPECT_NE(refusal_of({sunk}).find("hangs in the floor"), std::string::npos);
  EXPECT_NE(refusal_of({kTop, kTop}).find("two sensors are named top"), std::string::npos);
  auto second = kFront;
  second.name = "rear";
  EXPECT_NE(refusal_of({kFront, second}).find("two sensors have the address 192.168.0.1:2112"),
            std::string::npos);
  auto alike = kTop;
  alike.name = "other";
  alike.address = ":2368";
  EXPECT_NE(refusal_of({kTop, alike}).find("two sensors have the address"), std::string::npos)
      << "one port, written in another way";
  alike.address = ":2369";
  EXPECT_EQ(refusal_of({kTop, alike}), "");
  auto slow = kFront;
  slow.settings["rate_hz"] = "30";
  EXPECT_NE(refusal_of({slow}).find("measures at no such rate"), std::string::npos);
  auto rare = kFront;
  rare.settings["poll_hz"] = "0.2";
  EXPECT_NE(refusal_of({rare}).find("choose one from 0.3 to 25"), std::string::npos) << refusal_of({rare});
  rare.settings["poll_hz"] = "0.3";
  EXPECT_EQ(refusal_of({rare}), "");
  EXPECT_NEAR(lidar_model(rare).period_s, 3.33, 0.01);
  auto odd = kLeft;
  odd.settings["colour"] = "yellow";
  EXPECT_NE(refusal_of({odd}).find("the setting \"colour\" is not known - it knows: baud, every"),
            std::string::npos);
  auto field = kFront;
  field.protective_m = 0.5;
  EXPECT_NE(refusal_of({field}).find("has no protective field"), std::string::npos);
}

TEST(Lidars, WhoLiesOnTheFloorIsSeenByWhatLooksDownOrStandsLow) {
  const auto lowest_m = [](std::vector<mapping::SensorRecord> sensors) {
    return lowest_ahead_m(lidars_of(site_with(std::move(sensors)), "hall"));
  };
  auto backwards = kLeft;
  backwards.yaw_deg = 180.0;
  EXPECT_EQ(lowest_m({kTop}), 0.0);
  EXPECT_EQ(lowest_m({kFront}), 0.25);
  EXPECT_EQ(lowest_m({kFront, kLeft}), 0.15);
  EXPECT_EQ(lowest_m({kFront, backwards}), 0.25);
  EXPECT_GT(lowest_m({backwards}), 100.0) << "nothing looks ahead";
}

TEST(Lidars, HowFarAheadWhoLiesThereIsSureFollowsFromHeightAndBeams) {
  const auto sure_m = [](std::vector<mapping::SensorRecord> sensors) {
    return sure_low_m(lidars_of(site_with(std::move(sensors)), "hall"), 0.8, 8.0);
  };
  const auto top_at = [](double z_m) {
    auto top = kTop;
    top.z_m = z_m;
    return top;
  };
  auto low = kFront;
  low.z_m = 0.18;
  EXPECT_EQ(sure_m({kFront}), 0.0) << "it looks over him";
  EXPECT_NEAR(sure_m({low}), 8.0, 0.1) << "a body of 200 mm between two beams";
  EXPECT_NEAR(sure_m({top_at(1.2)}), 1.0 / std::tan(to_rad(15.0)) - 0.5, 0.01)
      << "where the lowest beam passes over";
  EXPECT_GT(sure_m({top_at(2.2)}), 6.5);
  EXPECT_EQ(sure_m({top_at(2.6)}), 0.0) << "farther away than what was seen is remembered";
  EXPECT_EQ(sure_m({kFront, top_at(1.2)}), sure_m({top_at(1.2)}));
}

TEST(Lidars, WhoLooksOverTheFloorDrivesSlowlyUnlessTheSiteSaysWhatElseGuards) {
  const auto fastest_mps = [](std::vector<LidarModel> lidars, const std::string& guard) {
    CycleConfig config = vehicle_config({}, std::move(lidars));
    config.low_bodies_guarded_by = guard;
    CycleState state(config, nullptr);
    const Stamp now = state.begun = stamp_from_seconds(1.0);
    state.lidars_heard.assign(config.lidars.size(), Hearing{now, {}});
    CycleInput input;
    input.now = now;
    return allowed_mps(state, input, config);
  };
  auto low = kFront;
  low.z_m = 0.18;
  EXPECT_DOUBLE_EQ(fastest_mps({lidar_model(kFront)}, ""), 0.3);
  EXPECT_GT(fastest_mps({lidar_model(kFront)}, "bumper of 0.5 m"), 1.0);
  EXPECT_GT(fastest_mps({lidar_model(low)}, ""), 1.0);
  EXPECT_GT(fastest_mps({lidar_model(kTop)}, ""), 1.0) << "it has seen him before he is too near";
}

TEST(Lidars, TheCommandLineSaysWhereTheyAre) {
  SocketOptions options;
  options.lidar_port = 4000;
  options.network_scanner = "10.0.0.7";
  options.safety_scanner = "/dev/ttyS4";
  options.scanner_baud = 125'000;
  const auto found = addressed({kTop, kFront, kLeft}, options);
  EXPECT_EQ(found[0].address, "0.0.0.0:4000");
  EXPECT_EQ(found[1].address, "10.0.0.7");
  EXPECT_EQ(found[2].address, "/dev/ttyS4");
  EXPECT_EQ(found[2].settings.at("baud"), "125000");
  EXPECT_EQ(addressed({kTop}, options).size(), 2U)
      << "a scanner that the site does not name stops it all the same";
  options.addresses = {"front=10.0.0.9:2111"};
  EXPECT_EQ(addressed({kTop, kFront}, options)[1].address, "10.0.0.9:2111");
  options.addresses = {"back=10.0.0.9"};
  EXPECT_THROW((void)addressed({kTop, kFront}, options), Error);
}

TEST(FoundDevices, OfTwoLidarsOfATypeEachIsHeardForItself) {
  mapping::SensorRecord front, rear;
  front.name = "front", rear.name = "rear";
  front.type = rear.type = "s300";
  rear.address = "/dev/ttyUSB2";
  std::vector<hmi::DeviceStatus> live(2);
  live[0].type = live[1].type = "s300";
  live[0].healthy = true;
  const auto found = found_devices({}, {front, rear}, live);
  ASSERT_GE(found.size(), 2U);
  EXPECT_TRUE(found[0].heard);
  EXPECT_FALSE(found[1].heard);
}

}  // namespace
}  // namespace madori::app
