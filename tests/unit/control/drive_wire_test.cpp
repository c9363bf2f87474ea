#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "control/drive_link/wire.hpp"

extern "C" std::size_t madori_freestanding_stop_frame(unsigned char* out);

namespace madori::control::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class Message>
Bytes framed(const Message& message) {
  Bytes out(kMaxFrame);
  out.resize(encode(message, out.data()));
  return out;
}

template <class Message>
Verdict read(Bytes frame, Message& message) {
  frame.pop_back();
  return decode(frame.data(), frame.size(), message);
}

std::string hex(const Bytes& bytes) {
  std::ostringstream out;
  for (const int byte : bytes)
    out << (out.tellp() ? " " : "") << std::hex << std::uppercase << byte / 16 << byte % 16;
  return out.str();
}

TEST(Crc16, HasTheCatalogueCheckValue) {
  EXPECT_EQ(crc16(reinterpret_cast<const std::uint8_t*>("123456789"), 9), 0x29B1);
}

RC_GTEST_PROP(Cobs, RoundTripsWithoutAZero, ()) {
  const auto bytes =
      *rc::gen::container<Bytes>(*rc::gen::inRange(1, 255), rc::gen::inRange<std::uint8_t>(0, 4));
  Bytes stuffed(bytes.size() + kCobsOverhead);
  stuffed.resize(cobs_encode(bytes.data(), bytes.size(), stuffed.data()));
  RC_ASSERT(std::find(stuffed.begin(), stuffed.end(), 0) == stuffed.end());
  Bytes back(bytes.size());
  back.resize(cobs_decode(stuffed.data(), stuffed.size(), back.data(), back.size()));
  RC_ASSERT(back == bytes);
}

Command any_command() {
  const auto speed = rc::gen::inRange<std::int32_t>(-kMaxWheelSpeed, kMaxWheelSpeed + 1);
  return {*rc::gen::arbitrary<std::uint16_t>(), *rc::gen::arbitrary<bool>(), *speed, *speed};
}

RC_GTEST_PROP(DriveWire, CommandsRoundTrip, ()) {
  const Command sent = any_command();
  Command got;
  RC_ASSERT(read(framed(sent), got) == Verdict::Good);
  RC_ASSERT(got.sequence == sent.sequence && got.enable == sent.enable);
  RC_ASSERT(got.left_uradps == sent.left_uradps && got.right_uradps == sent.right_uradps);
}

RC_GTEST_PROP(DriveWire, StatusRoundTrips, ()) {
  Status sent;
  sent.sequence = *rc::gen::arbitrary<std::uint16_t>();
  sent.state = static_cast<DriveState>(*rc::gen::inRange(0, 6));
  sent.bumper = *rc::gen::arbitrary<bool>();
  sent.faults = *rc::gen::arbitrary<std::uint16_t>();
  sent.time_us = *rc::gen::arbitrary<std::uint32_t>();
  sent.left_angle = *rc::gen::inRange<std::uint16_t>(0, kCountsPerTurn);
  sent.left_turns = *rc::gen::arbitrary<std::int16_t>();
  sent.battery_mv = *rc::gen::arbitrary<std::uint16_t>();
  const Bytes frame = framed(sent);
  Status got;
  RC_ASSERT(read(frame, got) == Verdict::Good);
  RC_ASSERT(framed(got) == frame);
  RC_ASSERT(got.left_angle == sent.left_angle && got.left_turns == sent.left_turns &&
            got.time_us == sent.time_us);
}

RC_GTEST_PROP(DriveWire, AnySingleDamagedByteIsNoticed, ()) {
  const Command sent = any_command();
  Bytes frame = framed(sent);
  const auto at = *rc::gen::inRange<std::size_t>(0, frame.size() - 1);
  frame[at] = static_cast<std::uint8_t>(frame[at] ^ *rc::gen::inRange<std::uint8_t>(1, 255));
  Command got;
  RC_ASSERT(read(frame, got) != Verdict::Good);
}

TEST(DriveWire, SaysWhatIsWrong) {
  Command command;
  EXPECT_EQ(decode(nullptr, 0, command), Verdict::BadStuffing);
  EXPECT_EQ(read(framed(Status{}), command), Verdict::BadType);
  command.left_uradps = kMaxWheelSpeed + 1;
  EXPECT_EQ(read(framed(command), command), Verdict::BadValue);
}

TEST(FrameCutter, FindsFramesInAStreamAfterNoise) {
  FrameCutter cutter;
  Bytes stream(100, 0x55);  // longer than any frame
  stream.push_back(0);
  for (int i = 0; i < 3; ++i)
    for (const auto byte : framed(Command{static_cast<std::uint16_t>(i), true, 5, -5}))
      stream.push_back(byte);
  std::vector<int> sequences;
  for (const auto byte : stream) {
    Command command;
    if (cutter.push(byte) && decode(cutter.frame(), cutter.size(), command) == Verdict::Good)
      sequences.push_back(command.sequence);
  }
  EXPECT_EQ(sequences, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(cutter.overflows(), 1U);
}

/// The frames that docs/reference/drive-link.md prints are these.
TEST(DriveWire, TheManualsExamplesAreRight) {
  std::ifstream stream(MADORI_SOURCE_DIR "/docs/reference/drive-link.md");
  const std::string manual(std::istreambuf_iterator<char>(stream), {});
  Status status;
  status.sequence = 7;
  status.command_sequence = 258;
  status.state = DriveState::Running;
  status.time_us = 1'000'000;
  status.left_angle = 8191;
  status.right_angle = 16383;
  status.left_turns = -1;
  status.right_turns = 2;
  status.battery_mv = 25200;
  for (const Bytes& frame : {framed(Command{258, true, 5'000'000, -2'500'000}), framed(status)})
    EXPECT_NE(manual.find("`" + hex(frame) + "`"), std::string::npos) << hex(frame);
}

TEST(DriveWire, IsTheSameForFirmware) {
  Bytes frame(kMaxFrame);
  frame.resize(madori_freestanding_stop_frame(frame.data()));
  Status status;
  ASSERT_EQ(read(frame, status), Verdict::Good);
  EXPECT_EQ(status.state, DriveState::EmergencyStop);
  EXPECT_EQ(status.time_us, 1000U);
}

}  // namespace
}  // namespace madori::control::wire
