#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/angle.hpp"
#include "sensors/pcap/reader.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "sensors/vlp16/encode.hpp"

namespace madori::sensors::vlp16 {
namespace {

namespace fs = std::filesystem;

fs::path shared(const std::string& name) {
  return fs::path(MADORI_SHARED_DATA) / "vlp16" / name;
}

/// Pushes all data packets of a capture, then flushes.
void play(const fs::path& file, Assembler& assembler) {
  pcap::PcapReader reader(file);
  while (const auto packet = reader.next())
    if (packet->udp.destination_port == kDataPort) assembler.push(packet->udp.bytes, packet->captured);
  assembler.flush();
}

/// A revolving sensor in a room where everything stands `distance` units away.
class Sensor {
 public:
  explicit Sensor(ReturnMode mode = ReturnMode::Strongest) : mode_(mode) {}

  std::array<std::uint8_t, kDataBytes> next(std::uint16_t distance = 1000) {
    DataPacket packet;
    packet.mode = mode_;
    packet.time_us = static_cast<std::uint32_t>(std::llround(time_us_)) % kMicrosecondsPerHour;
    const std::size_t stride = mode_ == ReturnMode::Dual ? 2 : 1;
    for (std::size_t b = 0; b < kBlocks; ++b) {
      packet.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(azimuth_);
      packet.blocks[b].returns.fill({static_cast<std::uint16_t>(distance + (b % stride)), 7});
      if ((b + 1) % stride == 0) azimuth_ = (azimuth_ + step_cdeg_) % 36'000;
    }
    time_us_ += packet_us(mode_);
    return encode(packet);
  }
  void set_time_us(double time_us) { time_us_ = time_us; }
  void set_step_cdeg(int step_cdeg) { step_cdeg_ = step_cdeg; }
  [[nodiscard]] double time_us() const { return time_us_; }

 private:
  ReturnMode mode_;
  int azimuth_ = 0;
  int step_cdeg_ = 40;  ///< a block, of 10 Hz
  double time_us_ = 1'000'000.0;
};

struct Collected {
  std::vector<Frame> frames;
  FrameSink sink = [this](Frame& frame) { frames.push_back(std::move(frame)); };
};

Stamp at_us(double time_us) {
  return Stamp(std::chrono::nanoseconds(std::llround(time_us * 1000.0)));
}

TEST(Vlp16Capture, HasThePeersFramesCountsAndPoints) {
  const auto file = shared("vlp-16-test-90deg-1-50-frames.pcap");
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  Collected got;
  Assembler assembler(got.sink);
  play(file, assembler);
  ASSERT_EQ(got.frames.size(), 52U);
  EXPECT_EQ(assembler.counters().packets, 1902U);
  EXPECT_EQ(assembler.counters().lost + assembler.counters().late + assembler.counters().refused, 0U);

  std::ifstream expected(shared("vlp-16.test"));
  std::size_t frame = 0, checked_counts = 0, checked_points = 0;
  for (std::string word; expected >> word;) {
    if (word == "frame") expected >> frame;
    if (word == "point_count") {
      std::size_t count = 0;
      expected >> count;
      EXPECT_EQ(got.frames.at(frame).cloud.points.size(), count) << "frame " << frame;
      ++checked_counts;
    }
    if (word != "point_values") continue;
    std::size_t index = 0;
    double x = 0.0, y = 0.0, z = 0.0;
    int intensity = 0;
    expected >> index >> x >> y >> z >> intensity;
    const auto& points = got.frames.at(frame).cloud.points;
    const CloudPoint& point = points.at(index);
    // The manual's frame is x right, y forward. The peer interpolates the packet's last block otherwise.
    const double tolerance_m = index + 1 == points.size() ? 0.03 : 1e-3;
    EXPECT_NEAR(-point.y_m, x, tolerance_m);
    EXPECT_NEAR(point.x_m, y, tolerance_m);
    EXPECT_NEAR(point.z_m, z, 1e-3);
    EXPECT_EQ(point.intensity, intensity);
    ++checked_points;
  }
  EXPECT_EQ(checked_counts, 5U);
  EXPECT_EQ(checked_points, 2U);
}

TEST(Vlp16Capture, EinrideTurnsThirteenTimes) {
  const auto file = shared("einride_recording.bin");
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  std::ifstream stream(file, std::ios::binary);
  Collected got;
  Assembler assembler(got.sink);
  std::vector<char> packet(kDataBytes);
  while (stream.read(packet.data(), kDataBytes))
    assembler.push({reinterpret_cast<const std::uint8_t*>(packet.data()), kDataBytes}, {});
  EXPECT_EQ(got.frames.size(), 13U);
  for (std::size_t i = 1; i < got.frames.size(); ++i) EXPECT_NEAR(got.frames[i].blocks, 903, 3) << i;
  EXPECT_EQ(assembler.counters().packets, 1000U);
  EXPECT_EQ(assembler.counters().lost, 0U);
}

TEST(Vlp16Capture, AnHdl32IsRefusedByName) {
  const auto file = shared("not_vlp16_hdl32.pcap");
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  Collected got;
  Assembler assembler(got.sink);
  play(file, assembler);
  EXPECT_EQ(assembler.foreign_sensor(), "HDL-32E");
  EXPECT_TRUE(got.frames.empty());
}

TEST(Vlp16Assembler, AnotherModelThatHasGoneIsForgotten) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor other, lidar;
  for (int i = 0; i < 20; ++i) {  // as an HDL-32E sends: every 553 us
    const auto packet = other.next();
    other.set_time_us(1'000'000.0 + 553.0 * (i + 1));
    assembler.push(packet, at_us(other.time_us()));
  }
  ASSERT_FALSE(assembler.foreign_sensor().empty());
  lidar.set_time_us(2'000'000.0);
  for (int i = 0; i < 1'000; ++i) {
    const auto packet = lidar.next();
    assembler.push(packet, at_us(lidar.time_us()));
  }
  EXPECT_EQ(assembler.foreign_sensor(), "");
  EXPECT_GE(got.frames.size(), 2U);
}

TEST(Vlp16Capture, ThePositionPacketTellsTheTime) {
  const auto file = shared("position.pcap");
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  pcap::PcapReader reader(file);
  const auto packet = reader.next();
  ASSERT_TRUE(packet);
  const auto position = decode_position(packet->udp.bytes);
  ASSERT_TRUE(position);
  EXPECT_EQ(position->gprmc, "$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*05");
  const auto again = decode_position(encode(*position));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->gprmc, position->gprmc);
  EXPECT_EQ(again->time_us, position->time_us);
}

TEST(Vlp16Assembler, PointsStandWhereTheyWereHit) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  for (int i = 0; i < 160; ++i) {
    const auto packet = sensor.next();
    assembler.push(packet, at_us(sensor.time_us()));
  }
  ASSERT_EQ(got.frames.size(), 2U);
  for (const auto& frame : got.frames) {
    EXPECT_EQ(frame.blocks, 900);
    ASSERT_EQ(frame.cloud.points.size(), 28'800U);
    for (const CloudPoint& p : frame.cloud.points) {
      const double azimuth = to_rad(p.time_offset_s * 1e6 / (2.0 * kFiringUs) * 0.4);
      ASSERT_NEAR(std::hypot(p.x_m, p.y_m, p.z_m), 2.0, 1e-5);
      ASSERT_NEAR(wrap_angle(std::atan2(-p.y_m, p.x_m) - azimuth), 0.0, 5e-5) << p.time_offset_s;
      ASSERT_NEAR(to_deg(std::asin(p.z_m / 2.0)), -15.0 + 2.0 * p.ring, 1e-3);
    }
  }
  const double apart_s = to_seconds(got.frames[1].cloud.stamp - got.frames[0].cloud.stamp);
  EXPECT_NEAR(apart_s, 900 * 2 * kFiringUs * 1e-6, 2e-5);
  EXPECT_NEAR(to_seconds(got.frames[0].cloud.stamp), 1.0, 1e-5);
}

TEST(Vlp16Assembler, CountsAndSurvivesLossRepetitionAndDelay) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  auto before = sensor.next();
  for (int i = 0; i < 300; ++i) {
    const auto packet = sensor.next();
    if (i % 50 == 10) continue;  // lost
    EXPECT_EQ(assembler.push(packet, {}), PushVerdict::Taken);
    if (i % 50 == 20) {
      EXPECT_EQ(assembler.push(packet, {}), PushVerdict::Duplicate);
    }
    if (i % 50 == 30) {
      EXPECT_EQ(assembler.push(before, {}), PushVerdict::Late);
    }
    before = packet;
  }
  EXPECT_EQ(assembler.counters().lost, 6U);
  EXPECT_EQ(assembler.counters().duplicates, 6U);
  EXPECT_EQ(assembler.counters().late, 6U);
  EXPECT_EQ(got.frames.size(), 4U);
}

TEST(Vlp16Assembler, AStandingRotorMakesNoFramesAndGathersNothing) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  for (int i = 0; i < 100; ++i) assembler.push(sensor.next(), {});
  ASSERT_EQ(got.frames.size(), 1U);
  EXPECT_FALSE(assembler.rotor_stands());
  sensor.set_step_cdeg(0);
  for (int i = 0; i < 3'000; ++i) assembler.push(sensor.next(), {});  // four seconds
  EXPECT_EQ(got.frames.size(), 1U);
  EXPECT_TRUE(assembler.rotor_stands());
  sensor.set_step_cdeg(40);
  for (int i = 0; i < 150; ++i) assembler.push(sensor.next(), {});
  EXPECT_FALSE(assembler.rotor_stands());
  ASSERT_GE(got.frames.size(), 2U);
  for (const Frame& frame : got.frames)
    for (const CloudPoint& p : frame.cloud.points) ASSERT_LT(p.time_offset_s, 0.26F);
}

TEST(Vlp16Assembler, TheSlowestTurnIsAFrame) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  sensor.set_step_cdeg(20);  // 5 Hz
  for (int i = 0; i < 460; ++i) assembler.push(sensor.next(), {});
  ASSERT_EQ(got.frames.size(), 3U);
  EXPECT_EQ(got.frames[1].blocks, 1'800);
}

TEST(Vlp16Assembler, TwoTurnsWithAWholeOneMissingBetweenThemAreTwoFrames) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  for (int i = 0; i < 40; ++i) assembler.push(sensor.next(), {});
  for (int i = 0; i < 80; ++i) (void)sensor.next();  // goes on a little beyond where it was lost
  for (int i = 0; i < 40; ++i) assembler.push(sensor.next(), {});
  ASSERT_GE(got.frames.size(), 1U);
  EXPECT_EQ(got.frames[0].blocks, 480);
  EXPECT_EQ(assembler.counters().lost, 80U);
}

TEST(Vlp16Assembler, NoPointIsOlderThanItsFrame) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor single, dual(ReturnMode::Dual);
  for (int i = 0; i < 74; ++i) assembler.push(single.next(), {});
  dual.set_time_us(single.time_us() + 10.0);  // too early for what was just sent
  assembler.push(dual.next(), {});
  dual.set_time_us(single.time_us() + 2000.0);
  for (int i = 0; i < 300; ++i) assembler.push(dual.next(), {});
  assembler.flush();
  EXPECT_GE(got.frames.size(), 3U);
  for (const Frame& frame : got.frames)
    for (const CloudPoint& p : frame.cloud.points) ASSERT_GE(p.time_offset_s, 0.0F);
}

TEST(Vlp16Assembler, GoesOnOverTheHour) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  sensor.set_time_us(3'600'000'000.0 - 30'000.0);
  for (int i = 0; i < 160; ++i)
    ASSERT_EQ(assembler.push(sensor.next(), at_us(sensor.time_us())), PushVerdict::Taken);
  EXPECT_EQ(got.frames.size(), 2U);
  EXPECT_EQ(assembler.counters().silences + assembler.counters().lost, 0U);
  EXPECT_NEAR(to_seconds(got.frames[1].cloud.stamp - got.frames[0].cloud.stamp), 0.0995, 1e-3);
}

TEST(Vlp16Assembler, WhatANetworkSendsOnceMoreLaterIsNoNewTime) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  std::vector<std::array<std::uint8_t, kDataBytes>> sent;
  constexpr std::size_t kBehind = 1130;  // 1.5 s
  for (std::size_t i = 0; i < 3000; ++i) {
    sent.push_back(sensor.next());
    const Stamp now = at_us(sensor.time_us());
    EXPECT_EQ(assembler.push(sent.back(), now), PushVerdict::Taken);
    if (i < kBehind) continue;
    EXPECT_EQ(assembler.push(sent[i - kBehind], now), PushVerdict::Late);
    if (i % 500 != 499 || i < 2 * kBehind) continue;
    for (std::size_t k = i - kBehind; k < i - kBehind + 300; ++k) assembler.push(sent[k], now);  // at once
  }
  EXPECT_EQ(assembler.counters().silences, 0U);
  ASSERT_EQ(got.frames.size(), 39U);
  for (const Frame& frame : got.frames) EXPECT_EQ(frame.blocks, 900);
}

TEST(Vlp16Assembler, AClockThatWasSetIsBelievedAfterATurn) {
  for (const double by_us : {-10e6, 10e6}) {
    Collected got;
    Assembler assembler(got.sink);
    Sensor sensor;
    sensor.set_time_us(100e6);
    for (int i = 0; i < 300; ++i) assembler.push(sensor.next(), at_us(sensor.time_us()));
    sensor.set_time_us(sensor.time_us() + by_us);
    int late = 0;
    for (int i = 0; i < 300; ++i)
      late += assembler.push(sensor.next(), at_us(sensor.time_us() - by_us)) == PushVerdict::Late ? 1 : 0;
    EXPECT_EQ(late, 76);  // packets of a turn
    EXPECT_EQ(assembler.counters().silences, 1U);
  }
}

TEST(Vlp16Assembler, ASensorThatWasSilentBeginsAtOnce) {
  Collected got;
  Assembler assembler(got.sink);
  Sensor sensor;
  sensor.set_time_us(100e6);
  for (int i = 0; i < 300; ++i) assembler.push(sensor.next(), at_us(sensor.time_us()));
  const double off_us = sensor.time_us() + 5e6;
  sensor.set_time_us(0.0);  // switched off and on
  EXPECT_EQ(assembler.push(sensor.next(), at_us(off_us)), PushVerdict::Taken);
}

TEST(Vlp16Assembler, ChoosesAmongDualReturns) {
  for (const auto& [choice, expected] : {std::pair{DualReturn::Strongest, 1}, std::pair{DualReturn::Last, 1},
                                         std::pair{DualReturn::Both, 2}}) {
    Collected got;
    Assembler assembler(got.sink, {choice});
    Sensor sensor(ReturnMode::Dual);
    for (int i = 0; i < 160; ++i) assembler.push(sensor.next(), {});
    ASSERT_EQ(got.frames.size(), 1U);
    EXPECT_EQ(got.frames[0].cloud.points.size(), 28'800U * static_cast<unsigned>(expected));
    const CloudPoint& p = got.frames[0].cloud.points.front();
    EXPECT_NEAR(std::hypot(p.x_m, p.y_m, p.z_m), choice == DualReturn::Strongest ? 2.002 : 2.0, 1e-5);
    EXPECT_NEAR(got.frames[0].cloud.points.back().time_offset_s, 0.0995, 2e-4);
  }
}

TEST(Vlp16Packet, RefusesWhatItIsNot) {
  const auto good = Sensor().next();
  DataPacket packet;
  EXPECT_EQ(decode(good, packet), PacketFault::None);
  EXPECT_EQ(decode(std::span(good).first(1205), packet), PacketFault::Length);
  const auto with = [&](std::size_t at, std::uint8_t value) {
    auto bytes = good;
    bytes[at] = value;
    return decode(bytes, packet);
  };
  EXPECT_EQ(with(0, 0), PacketFault::BlockFlag);
  EXPECT_EQ(with(1103, 0xFF), PacketFault::Azimuth);
  EXPECT_EQ(with(1203, 0xFF), PacketFault::Time);
  EXPECT_EQ(with(1204, 0x36), PacketFault::Mode);
  EXPECT_EQ(with(1205, 0x28), PacketFault::Product);
  EXPECT_EQ(with(1205, 0x21), PacketFault::None);
  Collected got;
  Assembler assembler(got.sink);
  auto jump = good;
  jump[303] = static_cast<std::uint8_t>(jump[303] ^ 0x40U);
  EXPECT_EQ(assembler.push(jump, {}), PushVerdict::Refused);
}

}  // namespace
}  // namespace madori::sensors::vlp16
