#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/angle.hpp"
#include "core/crc16.hpp"
#include "sensors/s300/encode.hpp"
#include "sensors/s300/scan_clock.hpp"

namespace madori::sensors::s300 {
namespace {

using Bytes = std::vector<std::uint8_t>;

Telegram scan_of(Variant variant, std::uint32_t number) {
  Telegram telegram;
  telegram.variant = variant;
  telegram.scan_number = number;
  telegram.telegram_number = static_cast<std::uint16_t>(number);
  for (std::uint16_t i = 0; i < 541; ++i)
    telegram.values.push_back(static_cast<std::uint16_t>(i * 3U + number));
  return telegram;
}

TEST(S300, TheRecordedReplysCrcIsOurs) {
  const auto file = std::filesystem::path(MADORI_SHARED_DATA) / "sick/s300_polled_reply.hex";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  std::ifstream stream(file);
  Bytes bytes;
  for (unsigned byte = 0; stream >> std::hex >> byte;) bytes.push_back(static_cast<std::uint8_t>(byte));
  ASSERT_EQ(bytes.size(), 176U);
  EXPECT_EQ(crc16(bytes.data() + 4, bytes.size() - 6), 0x2C2D);
  EXPECT_EQ(bytes[174] | (bytes[175] << 8), 0x2C2D);
}

TEST(S300, StatesItsSizeAsTheListingSays) {
  for (const auto& [variant, words] : {std::pair{Variant::V0201, 552}, std::pair{Variant::V0301, 550},
                                       std::pair{Variant::V0301WithFields, 547}}) {
    const Bytes bytes = encode(scan_of(variant, 1));
    EXPECT_EQ(bytes.size(), 1108U);
    EXPECT_EQ((bytes[6] << 8) | bytes[7], words);
  }
}

TEST(S300, ReadsEveryVariantInAnyPieces) {
  for (const auto variant : {Variant::V0201, Variant::V0301, Variant::V0301WithFields})
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{1000}, std::size_t{5000}}) {
      Bytes line{1, 0, 0, 0};  // noise, and zeros that look like the beginning
      std::vector<Telegram> sent, got;
      for (std::uint32_t i = 0; i < 4; ++i) {
        sent.push_back(scan_of(variant, i));
        const Bytes bytes = encode(sent.back());
        line.insert(line.end(), bytes.begin(), bytes.end());
      }
      Stream stream([&](const Telegram& telegram) { got.push_back(telegram); });
      for (std::size_t at = 0; at < line.size(); at += piece)
        stream.push(std::span(line).subspan(at, std::min(piece, line.size() - at)));
      EXPECT_EQ(got, sent);
      EXPECT_EQ(stream.counters().skipped_bytes, 4U);
      EXPECT_EQ(stream.counters().damaged, 0U);
    }
}

TEST(S300, ADamagedTelegramIsThrownAwayAndTheLossCounted) {
  Bytes line;
  for (std::uint32_t i = 0; i < 5; ++i) {
    Bytes bytes = encode(scan_of(Variant::V0301, i));
    if (i == 2) bytes[500] = static_cast<std::uint8_t>(bytes[500] ^ 0x10U);
    line.insert(line.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::uint32_t> numbers;
  Stream stream([&](const Telegram& telegram) { numbers.push_back(telegram.scan_number); });
  stream.push(line);
  EXPECT_EQ(numbers, (std::vector<std::uint32_t>{0, 1, 3, 4}));
  EXPECT_EQ(stream.counters().damaged, 1U);
  EXPECT_EQ(stream.counters().lost, 1U);
}

TEST(S300, FieldsStopTheVehicle) {
  Telegram telegram = scan_of(Variant::V0301, 1);
  EXPECT_FALSE(fields_of(telegram).must_stop());
  telegram.values[77] |= kWarningField;
  EXPECT_TRUE(fields_of(telegram).warning);
  EXPECT_FALSE(fields_of(telegram).must_stop());
  telegram.values[78] |= kProtectiveField;
  EXPECT_TRUE(fields_of(telegram).must_stop());
  EXPECT_FALSE(fields_of(telegram).standby);
  telegram.values.assign(541, kStandbyValue);
  EXPECT_TRUE(fields_of(telegram).standby);
  EXPECT_TRUE(fields_of(telegram).must_stop());
  EXPECT_EQ(to_laser_scan(telegram).ranges_m.front(), LaserScan::kNoReturn);
  telegram = scan_of(Variant::V0301, 1);
  telegram.status = 0x0100;
  EXPECT_TRUE(fields_of(telegram).must_stop());
}

TEST(S300, AScannerThatIsSwitchedOnAnewBeginsANewTime) {
  ScanClock clock(kBitsPerSecond);
  const auto off_s = [&](std::uint32_t number, double received_s) {
    const Stamp received = stamp_from_seconds(received_s);
    return to_seconds(received - clock.stamp_of(scan_of(Variant::V0301, number), received));
  };
  EXPECT_NEAR(off_s(100'000, 5'000.0), 0.052, 0.001);
  EXPECT_NEAR(off_s(100'025, 5'001.0), 0.052, 0.001);
  EXPECT_NEAR(off_s(2, 5'012.0), 0.052, 0.001);
  EXPECT_NEAR(off_s(27, 5'013.0), 0.052, 0.001);
}

TEST(S300, BecomesAScanThatLooksForward) {
  Telegram telegram = scan_of(Variant::V0301, 1);
  telegram.values[270] = 1234 | kReflector | kWarningField;
  telegram.values[0] = 0;
  telegram.values[1] = 0x1FFF;
  const LaserScan scan = to_laser_scan(telegram);
  ASSERT_EQ(scan.ranges_m.size(), 541U);
  EXPECT_NEAR(scan.angle_rad(270), 0.0, 1e-12);
  EXPECT_NEAR(to_deg(scan.angle_rad(540)), 135.0, 1e-9);
  EXPECT_FLOAT_EQ(scan.ranges_m[270], 12.34F);
  EXPECT_EQ(scan.ranges_m[0], LaserScan::kNoReturn);
  EXPECT_EQ(scan.ranges_m[1], LaserScan::kNoReturn);
}

}  // namespace
}  // namespace madori::sensors::s300
