// Beams of a width, systematic errors, wrong points and lidars that lean: laws, and oracles from geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.hpp"
#include "simulation/factory.hpp"
#include "simulation/lidar/plane_scanner.hpp"
#include "tests/support/receiver.hpp"
#include "tests/support/small_hall.hpp"

namespace madori::simulation {
namespace {

constexpr float kFar = 1000.0F;

Hit wall_at(float range_m, float incidence_cos = 1.0F) {
  Hit hit;
  hit.range_m = range_m;
  hit.incidence_cos = incidence_cos;
  return hit;
}

/// VLP-16 manual, 9.3.2: the odd block holds the second strongest where the strongest is the last as well.
TEST(DualReturn, TellsTwoEchoesWhereThereAreTwo) {
  const Echo near{2.0F, Material::Wall}, far{5.0F, Material::Wall};
  EXPECT_FLOAT_EQ((Echoes{near, near, far}.beside_last().range_m), 2.0F);
  EXPECT_FLOAT_EQ((Echoes{near, far, far}.beside_last().range_m), 2.0F);
  EXPECT_FLOAT_EQ((Echoes{far, far, far}.beside_last().range_m), 5.0F);
}

TEST(BeamSpot, LiesEvenlyAroundItsMiddle) {
  for (const std::size_t asked : {1U, 2U, 5U}) {
    const BeamSpot spot(0.008, 0.015, asked);
    ASSERT_EQ(spot.rays().size(), asked);
    double left = 0.0, up = 0.0;
    for (const auto& ray : spot.rays()) {
      left += ray.left, up += ray.up;
      EXPECT_LT(std::hypot(ray.left, ray.up), 1.0);
    }
    EXPECT_NEAR(left, 0.0, 1e-12);
    EXPECT_NEAR(up, 0.0, 1e-12);
  }
  EXPECT_EQ(BeamSpot(0.0, 0.0, 5).rays().size(), 1U) << "a beam without width is one ray";
}

TEST(BeamSpot, AnAnswerLiesBetweenTheNearestAndTheFarthestRayAndComesNearerAsTheNearSideGrows) {
  Random random(1, 2, 3);
  const BeamSpot spot(0.008, 0.015, 5);
  for (int trial = 0; trial < 20'000; ++trial) {
    std::array<Hit, 5> rays;
    float near = kFar, far = 0.0F;
    for (Hit& ray : rays) {
      if (random.uniform() < 0.2) continue;
      ray = wall_at(static_cast<float>(5.0 + (random.uniform() < 0.5 ? 0.4 : 3.0) * random.uniform()));
      near = std::min(near, ray.range_m), far = std::max(far, ray.range_m);
    }
    float before = kFar;
    for (const float share : {0.0F, 0.3F, 0.6F, 0.999F}) {
      const SpotHits met = meet(rays, spot, share);
      if (met.first.range_m == Hit::kNothing) continue;
      EXPECT_GE(met.first.range_m, near - 1e-5F);
      EXPECT_LE(met.last.range_m, far + 1e-5F);
      EXPECT_LE(met.first.range_m, met.last.range_m);
      EXPECT_LE(met.first.range_m, before + 1e-5F);
      before = met.first.range_m;
    }
  }
}

TEST(BeamSpot, OneSurfaceIsOneRangeHoweverItSlants) {
  const BeamSpot spot(0.008, 0.015, 5);
  for (const double slant_deg : {0.0, 30.0, 60.0, 75.0}) {
    const double tangent = std::tan(to_rad(slant_deg));
    std::array<Hit, 5> rays;
    for (std::size_t i = 0; i < rays.size(); ++i)
      rays[i] =
          wall_at(static_cast<float>(10.0 + tangent * spot.rays()[i].left * spot.diameter_m(10.0) / 2.0),
                  static_cast<float>(std::cos(to_rad(slant_deg))));
    for (const float share : {0.0F, 0.5F, 0.99F}) {
      EXPECT_NEAR(meet(rays, spot, share).first.range_m, 10.0F, 1e-4F) << slant_deg;
      EXPECT_NEAR(meet(rays, spot, share).last.range_m, 10.0F, 1e-4F) << slant_deg;
    }
  }
}

/// The near side takes `covered` of five rays; the other stands `gap_m` behind it.
SpotHits across_an_edge(std::size_t covered, float gap_m, float share) {
  std::array<Hit, 5> rays;
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = wall_at(i < covered ? 4.0F : 4.0F + gap_m);
  return meet(rays, BeamSpot(0.008, 0.015, 5), share);
}

TEST(BeamSpot, RangesMeltAcrossALowStepAndPartAcrossAHighOne) {
  for (std::size_t covered = 1; covered < 5; ++covered)
    for (const float share : {0.0F, 0.5F, 0.99F}) {
      const float of_near = (static_cast<float>(covered) - 0.5F + share) / 5.0F;
      const auto melted = across_an_edge(covered, 0.5F, share);
      EXPECT_NEAR(melted.first.range_m, 4.5F - 0.5F * of_near, 1e-5F);
      EXPECT_EQ(melted.first.range_m, melted.last.range_m);
      const auto parted = across_an_edge(covered, 2.0F, share);
      EXPECT_EQ(parted.first.range_m, of_near >= kLeastShare ? 4.0F : 6.0F);
      EXPECT_EQ(parted.last.range_m, 1.0F - of_near >= kLeastShare ? 6.0F : 4.0F);
      EXPECT_EQ(parted.strongest.range_m, of_near >= 0.5F ? 4.0F : 6.0F);
    }
}

TEST(RangeBias, StaysWithinTheDataSheetChangesSlowlyAndIsTheDevicesOwn) {
  constexpr double kMost = 0.03;
  double sum = 0.0, squares = 0.0;
  int devices = 0;
  for (std::uint64_t device = 0; device < 400; ++device, ++devices) {
    Random random(7, 1, device), again(7, 1, device);
    const RangeBias bias(kMost, random), twin(kMost, again);
    for (float range = 0.0F; range < 30.0F; range += 0.5F)
      for (const Material material : {Material::Wall, Material::Metal, Material::Cloth})
        for (float angle = -2.0F; angle < 2.0F; angle += 1.0F) {
          const float at = bias.at(range, angle, material);
          EXPECT_LE(std::abs(at), kMost + 1e-6);
          EXPECT_EQ(at, twin.at(range, angle, material));
          EXPECT_NEAR(at, bias.at(range + 0.1F, angle, material), 0.05 * kMost);
        }
    const double at_5m = static_cast<double>(bias.at(5.0F, 0.0F, Material::Wall));
    sum += at_5m, squares += at_5m * at_5m;
  }
  EXPECT_NEAR(sum / devices, 0.0, 0.1 * kMost);
  EXPECT_GT(std::sqrt(squares / devices), 0.2 * kMost) << "all devices are alike";
}

/// A scanner 0.25 m high in the middle of a hall of 60 m, perfect but for `errors`.
std::vector<Echo> scan_of(const LidarErrors& errors, const std::vector<Body>& bodies, std::uint64_t seed) {
  const FactorySetup setup = test::small_hall(60.0, 60.0, 30.0, 30.0);
  const World world(setup.walls, setup.scenario);
  PoseTrack track;
  track.add(Duration(0), {30.0, 30.0, 0.0});
  track.add(std::chrono::hours(1), {30.0, 30.0, 0.0});
  PlaneScannerOptions options;
  options.period = std::chrono::milliseconds(20);
  options.echo = {static_cast<float>(errors.noise_m), errors.dropout, errors.rain, 0.05F, 50.0F};
  options.spot = BeamSpot(errors.beam_m, errors.beam_spread_rad, 5);
  options.lean = {errors.pitch_deg, errors.roll_deg};
  Random random(seed, 1, 1);
  options.bias = RangeBias(errors.bias_m, random);
  return PlaneScanner({"front", "lms1xx", 0.0, 0.0, 0.25, 0.0}, options, seed)
      .measure({world, track, bodies});
}

Body pole(double range_m, double angle_rad, double width_m) {
  Body body;
  body.centre = {30.0 + range_m * std::cos(angle_rad), 30.0 + range_m * std::sin(angle_rad)};
  body.half_length_m = body.half_width_m = width_m / 2.0;
  body.round = true;
  body.z = {0.0, 2.0};
  return body;
}

/// Eq. 6.1-6.3 of the tele-operated mapping source: d0 + l (spread + step).
TEST(Scanner, MeetsTheLeastObjectOfItsDataSheetWhereverItStands) {
  LidarErrors beam;
  beam.beam_m = 0.008, beam.beam_spread_rad = 0.015;
  Random random(5, 5, 5);
  for (int trial = 0; trial < 150; ++trial) {
    const double range_m = random.uniform(1.0, 12.0), angle_rad = random.uniform(-2.0, 2.0);
    const double least_m = 0.008 + range_m * (0.015 + to_rad(0.5));
    const auto echoes = scan_of(beam, {pole(range_m, angle_rad, least_m)}, 1);
    const auto nearest = std::ranges::min_element(echoes, {}, &Echo::range_m);
    EXPECT_NEAR(nearest->range_m, range_m, least_m / 2.0 + 0.01) << range_m << " m, " << angle_rad;
  }
}

TEST(Scanner, AWideBeamMeetsAThinPoleThatALineMisses) {
  LidarErrors beam;
  beam.beam_m = 0.008, beam.beam_spread_rad = 0.015;
  Random random(6, 5, 5);
  int lines = 0, beams = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Body thin = pole(6.0, random.uniform(-2.0, 2.0), 0.03);
    const auto met = [&](const LidarErrors& errors) {
      const auto echoes = scan_of(errors, {thin}, 1);
      return std::ranges::any_of(echoes, [](const Echo& e) { return e.range_m < 20.0F; });
    };
    lines += met({}) ? 1 : 0;
    beams += met(beam) ? 1 : 0;
  }
  // A line is met where it lies within 30 mm of the 52 mm between two of them.
  EXPECT_NEAR(lines / 200.0, 0.03 / (6.0 * to_rad(0.5)), 0.1);
  EXPECT_GT(beams, lines);
}

TEST(Scanner, WrongPointsFallSinglyAndAsOftenAsAsked) {
  LidarErrors wet;
  wet.rain = 0.01;
  const auto dry = scan_of({}, {}, 1);
  int wrong = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto echoes = scan_of(wet, {}, seed);
    for (std::size_t i = 0; i < echoes.size(); ++i, ++all) {
      EXPECT_LE(echoes[i].range_m, dry[i].range_m);
      wrong += echoes[i].range_m < dry[i].range_m - 0.01F ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(wrong) / all, 0.01, 0.003);
}

TEST(Scanner, OneThatLeansMeetsTheFloorWhereGeometrySays) {
  LidarErrors nose_down;
  nose_down.pitch_deg = 3.0;
  const auto echoes = scan_of(nose_down, {}, 1);
  EXPECT_NEAR(echoes[270].range_m, 0.25 / std::sin(to_rad(3.0)), 0.01);  // straight ahead
  EXPECT_NEAR(echoes[90].range_m, 30.0, 0.01) << "to the side the axis does not tilt";
  LidarErrors left_up;
  left_up.roll_deg = 3.0;
  const auto rolled = scan_of(left_up, {}, 1);
  EXPECT_NEAR(rolled[90].range_m, 0.25 / std::sin(to_rad(3.0)), 0.01);  // to the right
  EXPECT_GT(rolled[450].range_m, 29.0) << "to the left it looks up";
}

TEST(ProtectiveField, IsNotEnteredBySingleWrongPoints) {
  FactorySetup setup = test::small_hall(40.0, 24.0, 10.0, 12.0);
  setup.scenario.s300.rain = 0.001;
  Factory factory(setup);
  test::Receiver receiver({});
  int near = 0;
  for (int second = 0; second < 60; ++second) {
    factory.step(std::chrono::seconds(1));
    receiver.push(factory.take_packets());
    ASSERT_TRUE(receiver.fields());
    EXPECT_FALSE(receiver.fields()->protective) << second;
    for (const auto& scan : receiver.s300_scans)
      for (std::size_t i = 240; i < 300; ++i) near += scan.ranges_m[i] < 0.6F ? 1 : 0;
    receiver.s300_scans.clear();
  }
  EXPECT_GT(near, 0) << "no wrong point lay in the field: nothing was tested";
}

}  // namespace
}  // namespace madori::simulation
