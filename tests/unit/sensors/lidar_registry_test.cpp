#include <gtest/gtest.h>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "sensors/lidar/registry.hpp"
#include "sensors/lms1xx/encode.hpp"
#include "sensors/s300/encode.hpp"

namespace madori::sensors {
namespace {

LidarSettings settings_of(const char* name, std::map<std::string, std::string> values = {}) {
  return {name, "", {0.7, 0.0, 0.3, 0.0}, std::move(values)};
}

/// A scan of the whole field of view, all at 3 m.
lms1xx::Bytes scan_of(lms1xx::Dialect dialect, std::uint16_t step, std::size_t beams,
                      lms1xx::ScanData data = {}) {
  data.channels16.push_back(
      {{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, step, std::vector<std::uint16_t>(beams, 3000)});
  return lms1xx::encode(dialect, data);
}

TEST(LidarRegistry, EveryRowMakesAModelThatCanBe) {
  ASSERT_GE(lidar_rows().size(), 3U);
  for (const LidarRow& row : lidar_rows()) {
    const LidarModel model = row.model(settings_of("nose"));
    EXPECT_EQ(model.type, row.type);
    EXPECT_EQ(model.name, "nose");
    EXPECT_DOUBLE_EQ(model.mounting.z_m, 0.3);
    EXPECT_LT(model.from_rad, model.to_rad);
    EXPECT_GT(model.step_rad, 0.0);
    EXPECT_GT(model.period_s, 0.0);
    EXPECT_EQ(model.kind == LidarKind::Planar, model.min_elevation_rad == model.max_elevation_rad);
    EXPECT_GT(model.sure_range_m(0.2), model.sure_range_m(0.07));
    EXPECT_NE(row.decoder(settings_of("nose"), [](LidarSweep&) {}), nullptr);
    EXPECT_EQ(find_lidar(row.type)->title, row.title);
  }
  EXPECT_EQ(find_lidar("sonar"), nullptr);
  EXPECT_THROW((void)lidar_of("sonar", "site.yaml"), Error);
}

TEST(LidarRegistry, AScannerThatMeasuresOtherwiseThanTheSiteSaysIsRefused) {
  const auto& row = lidar_of("lms1xx", "");
  for (const auto& [step, beams, sweeps] : {std::tuple{5'000, 541, 1}, {2'500, 1081, 0}, {5'000, 361, 0}}) {
    int seen = 0;
    const auto decoder = row.decoder(settings_of("front"), [&](LidarSweep&) { ++seen; });
    decoder->push(
        scan_of(lms1xx::Dialect::B, static_cast<std::uint16_t>(step), static_cast<std::size_t>(beams)),
        stamp_from_seconds(1.0));
    EXPECT_EQ(seen, sweeps) << step << ' ' << beams;
    EXPECT_EQ(decoder->counters().refused, 1U - static_cast<unsigned>(sweeps));
  }
}

/// A scanner that hangs itself up sends the same for ever; one in trouble says so and sends on.
TEST(LidarRegistry, AScanThatComesAgainOrIsNoneByItsScannersWordIsNotHandedOn) {
  int seen = 0;
  const auto decoder = lidar_of("lms1xx", "").decoder(settings_of("front"), [&](LidarSweep&) { ++seen; });
  std::uint64_t pushed = 0;
  const auto push = [&](std::uint32_t scan_time_us, std::uint8_t status) {
    lms1xx::ScanData data;
    data.scan_time_us = data.transmit_time_us = scan_time_us;
    data.status[1] = status;
    decoder->push(scan_of(lms1xx::Dialect::B, 5'000, 541, data),
                  stamp_from_seconds(1.0 + 0.02 * static_cast<double>(++pushed)));
    return seen;
  };
  constexpr std::uint8_t kGood = 0, kError = 1, kDirty = 2, kTooDirty = 4;
  EXPECT_EQ(push(0, kGood), 1);
  EXPECT_EQ(push(0, kGood), 1) << "again";
  EXPECT_EQ(push(20'000, kDirty), 2) << "it still measures";
  EXPECT_EQ(push(40'000, kError), 2);
  EXPECT_EQ(push(60'000, kTooDirty), 2);
  EXPECT_EQ(push(80'000, kGood), 3);
  EXPECT_EQ(decoder->counters().refused, 3U);
}

TEST(LidarRegistry, BothDialectsAndBothRatesAreRead) {
  const auto& row = lidar_of("lms1xx", "");
  for (const char* cola : {"A", "B"})
    for (const auto& [rate, step, beams] : {std::tuple{"50", 5'000, 541}, {"25", 2'500, 1081}}) {
      std::size_t ranges = 0;
      const auto decoder =
          row.decoder(settings_of("front", {{"cola", cola}, {"rate_hz", rate}}),
                      [&](LidarSweep& s) { ranges = std::get<LaserScan>(s.seen).ranges_m.size(); });
      decoder->push(scan_of(*cola == 'A' ? lms1xx::Dialect::A : lms1xx::Dialect::B,
                            static_cast<std::uint16_t>(step), static_cast<std::size_t>(beams)),
                    stamp_from_seconds(1.0));
      EXPECT_EQ(ranges, static_cast<std::size_t>(beams)) << cola << rate;
    }
}

TEST(LidarRegistry, DistancesAndFieldsComeFromTheSameTelegram) {
  std::vector<LidarSweep> sweeps;
  const auto decoder =
      lidar_of("s300", "").decoder(settings_of("safety", {{"every", "2"}}), [&](LidarSweep& s) {
        sweeps.push_back(std::move(s));
      });
  for (const std::uint32_t number : {10U, 12U}) {
    s300::Telegram telegram;
    telegram.scan_number = number;
    telegram.values.assign(541, 250);
    if (number == 12U) telegram.values[270] = static_cast<std::uint16_t>(50 | s300::kProtectiveField);
    decoder->push(s300::encode(telegram), stamp_from_seconds(1.0 + 0.04 * number));
  }
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].stop, "");
  EXPECT_NE(sweeps[1].stop, "");
  const auto& first = std::get<LaserScan>(sweeps[0].seen);
  const auto& second = std::get<LaserScan>(sweeps[1].seen);
  EXPECT_FLOAT_EQ(second.ranges_m[270], 0.5F);
  EXPECT_FLOAT_EQ(second.ranges_m[0], 2.5F);
  EXPECT_NEAR(to_seconds(second.stamp - first.stamp), 0.08, 1e-6);
  // 30 ms of turning and 22.2 ms on the line lie before the last byte.
  EXPECT_NEAR(to_seconds(stamp_from_seconds(1.4) - first.stamp), 0.0522, 3e-4);
}

}  // namespace
}  // namespace madori::sensors
