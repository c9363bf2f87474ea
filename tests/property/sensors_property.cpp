// Every decoder reads back what its encoder wrote, for random scans.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/angle.hpp"
#include "sensors/lms1xx/encode.hpp"
#include "sensors/s300/encode.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "sensors/vlp16/encode.hpp"

namespace madori::sensors {
namespace {

template <class T>
T any() {
  return *rc::gen::arbitrary<T>();
}
template <class T>
T within(T low, T high) {
  return *rc::gen::inRange<T>(low, high);
}

/// A packet of a sensor that turns evenly; `azimuth` and `time_us` go on from call to call.
vlp16::DataPacket any_packet(vlp16::ReturnMode mode, int& azimuth, double& time_us, int gap) {
  vlp16::DataPacket packet;
  packet.mode = mode;
  packet.time_us = static_cast<std::uint32_t>(time_us) % vlp16::kMicrosecondsPerHour;
  const std::uint64_t seed = any<std::uint32_t>();
  for (std::size_t b = 0; b < vlp16::kBlocks; ++b) {
    packet.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(azimuth);
    for (std::size_t i = 0; i < vlp16::kReturns; ++i) {
      const std::uint64_t mixed = (seed + b * 32 + i) * 0x9E3779B97F4A7C15ULL;
      const bool hit = (mixed >> 61U) != 0;
      packet.blocks[b].returns[i] = {static_cast<std::uint16_t>(hit ? mixed >> 40U : 0U),
                                     static_cast<std::uint8_t>(mixed >> 32U)};
    }
    if (mode != vlp16::ReturnMode::Dual || b % 2 == 1) azimuth = (azimuth + gap) % 36'000;
  }
  time_us += vlp16::packet_us(mode);
  return packet;
}

RC_GTEST_PROP(Vlp16, PacketsRoundTrip, ()) {
  int azimuth = within(0, 36'000);
  double time_us = within(0, 2'000'000'000);
  const auto mode = static_cast<vlp16::ReturnMode>(within(0x37, 0x3A));
  const vlp16::DataPacket sent = any_packet(mode, azimuth, time_us, within(20, 90));
  vlp16::DataPacket got;
  RC_ASSERT(vlp16::decode(vlp16::encode(sent), got) == vlp16::PacketFault::None);
  RC_ASSERT(got == sent);
}

struct Expected {
  double x_m, y_m, z_m, time_s;
};
/// The manual's formula in double, return by return.
Expected expected_point(const vlp16::DataPacket& packet, std::size_t b, std::size_t i, double gap_cdeg) {
  const std::size_t half = i / 16;
  const double firing = static_cast<double>(half), channel = static_cast<double>(i % 16);
  const double azimuth = to_rad(
      (packet.blocks[b].azimuth_cdeg + gap_cdeg * (55.296 * firing + 2.304 * channel) / 110.592) / 100.0);
  const double elevation = to_rad(vlp16::kElevationsDeg[i % 16]);
  const double range_m = 0.002 * packet.blocks[b].returns[i].distance;
  return {range_m * std::cos(elevation) * std::cos(azimuth),
          -range_m * std::cos(elevation) * std::sin(azimuth), range_m * std::sin(elevation),
          1e-6 * (110.592 * static_cast<double>(b) + 55.296 * firing + 2.304 * channel)};
}

RC_GTEST_PROP(Vlp16, PointsAreTheManualsFormula, ()) {
  const int gap = within(20, 90);
  int azimuth = within(0, 35'000 - 12 * gap);
  double time_us = 1e6;
  const auto packet = any_packet(vlp16::ReturnMode::Strongest, azimuth, time_us, gap);
  std::vector<CloudPoint> points;
  vlp16::Assembler assembler([&](vlp16::Frame& frame) { points = frame.cloud.points; });
  assembler.push(vlp16::encode(packet), {});
  assembler.flush();
  std::size_t next = 0;
  for (std::size_t b = 0; b < vlp16::kBlocks; ++b)
    for (std::size_t i = 0; i < vlp16::kReturns; ++i) {
      if (packet.blocks[b].returns[i].distance == 0) continue;
      RC_ASSERT(next < points.size());
      const CloudPoint& p = points[next++];
      const Expected e = expected_point(packet, b, i, gap);
      RC_ASSERT(std::abs(p.x_m - e.x_m) < 5e-5 && std::abs(p.y_m - e.y_m) < 5e-5 &&
                std::abs(p.z_m - e.z_m) < 5e-5);
      RC_ASSERT(std::abs(p.time_offset_s - e.time_s) < 1e-8);
      RC_ASSERT(p.intensity == packet.blocks[b].returns[i].reflectivity);
    }
  RC_ASSERT(next == points.size());
}

RC_GTEST_PROP(Vlp16, AnyDisorderIsCountedAndNothingIsTakenTwice, ()) {
  int azimuth = 0;
  double time_us = within(0, 2'000'000'000);
  std::uint64_t pushed = 0;
  std::vector<std::array<std::uint8_t, vlp16::kDataBytes>> packets;
  for (int i = 0; i < 40; ++i)
    packets.push_back(vlp16::encode(any_packet(vlp16::ReturnMode::Strongest, azimuth, time_us, 40)));
  for (int i = 0; i < 20; ++i)
    std::swap(packets[within<std::size_t>(0, 40)], packets[within<std::size_t>(0, 40)]);
  std::size_t points = 0, blocks = 0;
  vlp16::Assembler assembler([&](vlp16::Frame& frame) {
    points += frame.cloud.points.size();
    blocks += static_cast<std::size_t>(frame.blocks);
  });
  for (const auto& packet : packets) {
    const int copies = within(0, 3);
    for (int c = 0; c < copies; ++c, ++pushed) assembler.push(packet, {});
  }
  assembler.flush();
  const auto& counters = assembler.counters();
  RC_ASSERT(counters.packets + counters.duplicates + counters.late + counters.refused == pushed);
  RC_ASSERT(counters.refused == 0U);
  RC_ASSERT(blocks == counters.packets * vlp16::kBlocks);
  RC_ASSERT(counters.packets + counters.lost <= 40U);
}

template <class Value>
std::vector<lms1xx::Channel<Value>> any_channels(const char* name) {
  std::vector<lms1xx::Channel<Value>> channels(within<std::size_t>(0, 3));
  for (auto& channel : channels) {
    std::copy_n(name, channel.name.size(), channel.name.begin());
    channel.scale = static_cast<float>(within(1, 3));
    channel.offset = static_cast<float>(within(-5, 5));
    channel.start_angle = any<std::int32_t>();
    channel.angle_step = any<std::uint16_t>();
    channel.values.resize(within<std::size_t>(0, 1142));
    const auto seed = any<std::uint32_t>();
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      channel.values[i] = static_cast<Value>((seed + i) * 2'654'435'761U >> 7U);
  }
  return channels;
}

RC_GTEST_PROP(Lms1xx, ScansRoundTripInBothDialects, ()) {
  lms1xx::ScanData sent;
  sent.version = any<std::uint16_t>();
  sent.serial = any<std::uint32_t>();
  sent.status = {any<std::uint8_t>(), any<std::uint8_t>()};
  sent.telegram_counter = any<std::uint16_t>();
  sent.scan_counter = any<std::uint16_t>();
  sent.scan_time_us = any<std::uint32_t>();
  sent.transmit_time_us = any<std::uint32_t>();
  sent.inputs = {any<std::uint8_t>(), any<std::uint8_t>()};
  sent.scan_frequency = any<std::uint32_t>();
  sent.encoders.resize(within<std::size_t>(0, 4));
  for (auto& encoder : sent.encoders) encoder = {any<std::uint32_t>(), any<std::uint16_t>()};
  sent.channels16 = any_channels<std::uint16_t>("DIST1");
  sent.channels8 = any_channels<std::uint8_t>("RSSI1");
  for (const auto dialect : {lms1xx::Dialect::A, lms1xx::Dialect::B}) {
    lms1xx::Splitter splitter(dialect);
    splitter.push(lms1xx::encode(dialect, sent));
    const auto payload = splitter.next();
    RC_ASSERT(payload.has_value());
    const auto got = lms1xx::decode_scan(dialect, *payload);
    RC_ASSERT(got.ok());
    RC_ASSERT(got.value() == sent);
  }
}

RC_GTEST_PROP(S300, TelegramsRoundTripInEveryVariant, ()) {
  s300::Telegram sent;
  sent.variant = static_cast<s300::Variant>(within(0, 3));
  sent.device_address = static_cast<std::uint8_t>(within(7, 9));
  sent.status = any<std::uint16_t>();
  sent.scan_number = any<std::uint32_t>();
  sent.telegram_number = any<std::uint16_t>();
  sent.content =
      *rc::gen::element(s300::Content::InputsOutputs, s300::Content::Distances, s300::Content::Reflectors);
  sent.field = sent.content == s300::Content::InputsOutputs
                   ? std::uint16_t{0}
                   : static_cast<std::uint16_t>(0x1111 * within(1, 6));
  sent.values.resize(within<std::size_t>(1, 600));
  const auto seed = any<std::uint32_t>();
  for (std::size_t i = 0; i < sent.values.size(); ++i)
    sent.values[i] = static_cast<std::uint16_t>((seed + i) * 2'654'435'761U >> 9U);
  std::vector<s300::Telegram> got;
  s300::Stream stream([&](const s300::Telegram& telegram) { got.push_back(telegram); });
  const auto bytes = s300::encode(sent);
  const auto cut = within<std::size_t>(0, bytes.size());
  stream.push(std::span(bytes).first(cut));
  stream.push(std::span(bytes).subspan(cut));
  RC_ASSERT(got == std::vector<s300::Telegram>{sent});
}

}  // namespace
}  // namespace madori::sensors
