// Localization in the virtual factory with the VLP-16, shortened: the whole measurement is bench_factory,
// its figures stand in docs/reference/localization-figures.md.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <vector>

#include "simulation/lidar/vlp16_model.hpp"
#include "simulation/sensor_suite.hpp"
#include "tests/support/kidnappings.hpp"
#include "tests/support/localization_trial.hpp"

namespace madori::test {
namespace {

const std::filesystem::path kData = std::filesystem::path(MADORI_SOURCE_DIR) / "data";

/// Of a sensor with thin beams and without systematic errors, which they do not have.
TEST(UpperLasers, SeeBitForBitWhatTheWholeSensorSees) {
  TrialSetup setup = sample_factory_trial(kData, 30.0, 0);
  simulation::Vlp16Spec& spec = setup.scenario.vlp16;
  spec.beam_m = spec.beam_spread_rad = spec.bias_m = spec.rain = 0.0;
  const simulation::World world(setup.walls, setup.scenario);
  const auto mounting = simulation::default_sensors({}).front();
  simulation::PoseTrack track;
  for (int ms = 0; ms <= 120; ++ms)
    track.add(std::chrono::milliseconds(ms), {4.0 + 0.001 * ms, 22.0, 0.0005 * ms});
  simulation::Vlp16Model whole(mounting, setup.scenario.vlp16, 5, Duration(0));
  UpperLasers upper(mounting, setup.scenario.vlp16, 5);
  const std::vector<simulation::Body> nobody;
  int seen = 0;
  while (whole.next_complete() <= std::chrono::milliseconds(120)) {
    ASSERT_EQ(upper.next_complete(), whole.next_complete());
    const auto a = whole.measure({world, track, nobody});
    const auto b = upper.measure({world, track, nobody});
    EXPECT_EQ(a.time_us, b.time_us);
    for (std::size_t block = 0; block < sensors::vlp16::kBlocks; ++block) {
      EXPECT_EQ(a.blocks[block].azimuth_cdeg, b.blocks[block].azimuth_cdeg);
      for (std::size_t i = 1; i < sensors::vlp16::kReturns; i += 2) {
        ASSERT_EQ(a.blocks[block].returns[i].distance, b.blocks[block].returns[i].distance);
        seen += b.blocks[block].returns[i].distance > 0;
      }
    }
  }
  EXPECT_GT(seen, 10'000);
}

TEST(FactoryLocalization, CentimetresWithAThirdOfTheWallsHidden) {
  LocalizationTrial trial(sample_factory_trial(kData, 30.0, 0), 1);
  ASSERT_TRUE(trial.drive(60.0, 600.0));
  const TrialFigures& f = trial.figures();
  EXPECT_GE(f.first_fix_s, 0.0);
  EXPECT_LT(f.first_fix_s, 1.0);
  EXPECT_LE(f.rmse_m(), 0.02);
  EXPECT_LE(to_deg(f.rmse_rad()), 0.1);
  EXPECT_EQ(f.losses, 0);
  EXPECT_LT(f.degraded_share(), 0.01);
}

TEST(FactoryLocalization, BetterStillWithNothingInTheWay) {
  LocalizationTrial trial(sample_factory_trial(kData, 0.0, 0), 1);
  ASSERT_TRUE(trial.drive(40.0, 400.0));
  EXPECT_LT(trial.figures().rmse_m(), 0.016);
  EXPECT_LT(to_deg(trial.figures().rmse_rad()), 0.09);
  EXPECT_EQ(trial.figures().losses, 0);
}

/// Whether it finds itself on the first metres that it drives.
bool finds_itself_driving(LocalizationTrial& trial) {
  for (double t = 0.0; t < 15.0; t += LocalizationTrial::kStep_s) {
    trial.step(true);
    if (trial.pose().health.state == LocalizationState::Localized && trial.error_m() < 0.2) return true;
  }
  return false;
}

TEST(FactoryLocalization, ACarriedOffVehicleIsLostWithinTwoSecondsAndFindsItself) {
  LocalizationTrial trial(sample_factory_trial(kData, 30.0, 0), 1);
  Kidnapper kidnapper(trial, 1);
  int found_standing = 0;
  for (int i = 0; i < 8; ++i) {  // all kinds, standing and driving
    const Kidnapping k = kidnapper.carry_out(i);
    EXPECT_TRUE(k.lost_after_s >= 0.0 || k.followed()) << "number " << i << ", by " << k.by_m << " m";
    EXPECT_LE(k.lost_after_s, 2.0) << "number " << i << ", by " << k.by_m << " m";
    EXPECT_LE(k.believed_wrong_s, 0.5) << "number " << i << ", by " << k.by_m << " m";
    const bool found = k.found_after_s >= 0.0;
    found_standing += found && !k.drives ? 1 : 0;
    EXPECT_TRUE(found || (!k.drives && finds_itself_driving(trial)))
        << "number " << i << ": " << trial.pose().health.reason;
  }
  EXPECT_GE(found_standing, 2) << "of 4, two of them in bays and docks that look like others";
}

}  // namespace
}  // namespace madori::test
