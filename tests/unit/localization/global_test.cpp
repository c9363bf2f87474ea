#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>

#include "localization/global/circular_match.hpp"
#include "localization/global/global_localizer.hpp"
#include "localization/global/scan_noise.hpp"
#include "tests/support/hall_trials.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

bool right(const GlobalAnswer& answer, const Pose& truth) {
  if (answer.hypotheses.empty()) return false;
  const Pose& pose = answer.hypotheses.front().fit.map_from_base;
  return distance_m(pose.translation(), truth.translation()) < 0.2 &&
         std::abs(wrap_angle(pose.yaw_rad() - truth.yaw_rad())) < to_rad(2.0);
}

ScanPoints scan_of(const mapping::Walls& walls, const Pose& pose, double clutter, std::mt19937& engine) {
  test::ScanSettings settings;
  settings.range_sigma_m = 0.01;
  settings.clutter = clutter;
  return scan_points(test::simulate_scan(walls, pose, settings, engine), {});
}

TEST(CircularMatch, IsWhatBruteForceFinds) {
  std::mt19937 engine(2);
  std::uniform_int_distribution<int> byte(0, 255);
  constexpr std::size_t kPlaces = 5;
  std::vector<std::uint8_t> scan(64), views(kPlaces * 64);
  for (auto& v : scan) v = static_cast<std::uint8_t>(byte(engine));
  for (auto& v : views) v = static_cast<std::uint8_t>(byte(engine));
  scan[3] = scan[17] = 255;
  std::vector<std::uint16_t> expected(kPlaces * 64), found(kPlaces * 64);
  for (std::size_t p = 0; p < kPlaces; ++p)
    for (std::size_t turn = 0; turn < 64; ++turn)
      for (std::size_t i = 0; i < 64; ++i)
        if (scan[i] != 255)
          expected[p * 64 + turn] = static_cast<std::uint16_t>(
              expected[p * 64 + turn] + std::min(9, std::abs(scan[i] - views[p * 64 + (i + turn) % 64])));
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    circular_match(scan.data(), views.data(), kPlaces, 9, found.data());
    EXPECT_EQ(found, expected) << hwy::TargetName(targets & -targets);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(PlaceIndex, SurvivesSavingAndRefusesWhatIsNotItsOwn) {
  const test::TemporaryFolder folder;
  mapping::Walls walls = test::laboratory_hall();
  const mapping::DistanceField field(walls);
  const PlaceIndex index(walls, field, {.spacing_m = 1.0});
  ASSERT_GT(index.size(), 100U);
  const auto file = folder.path() / "places.bin";
  index.save(file, walls);
  const auto loaded = PlaceIndex::load(file, walls, {.spacing_m = 1.0});
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->places(), index.places());
  EXPECT_TRUE(std::equal(loaded->views().begin(), loaded->views().end(), index.views().begin()));
  EXPECT_FALSE(PlaceIndex::load(file, walls, {.spacing_m = 0.5}));
  EXPECT_FALSE(PlaceIndex::load(folder.path() / "absent", walls));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  EXPECT_FALSE(PlaceIndex::load(file, walls, {.spacing_m = 1.0}));
  index.save(file, walls);
  walls[0].segment.b.x_m += 0.5;
  EXPECT_FALSE(PlaceIndex::load(file, walls, {.spacing_m = 1.0}));
}

TEST(PlaceIndex, SeesFromAPlaceWhatAScanSeesThere) {
  const mapping::Walls walls = test::laboratory_hall();
  const PlaceIndex index(walls, mapping::DistanceField(walls), {.spacing_m = 1.0});
  std::mt19937 engine(4);
  int alike = 0, compared = 0;
  for (std::size_t p = 0; p < index.size(); p += 7) {
    const Pose pose(index.places()[p].x_m, index.places()[p].y_m, 0.0);
    const LaserScan scan = test::simulate_scan(walls, pose, test::full_turn(720, 40.0), engine);
    const PlaceIndex::View view = index.view(scan_points(scan, {}));
    for (std::size_t i = 0; i < 64; ++i, ++compared)
      alike += std::abs(view[i] - index.views()[p * 64 + i]) <= 3;
  }
  EXPECT_GT(alike, 0.85 * compared);  // the rest are edges within a section
}

class Global : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    walls = new mapping::Walls(test::factory_floor());
    global = new GlobalLocalizer(*walls);
  }
  static void TearDownTestSuite() {
    delete global;
    delete walls;
  }
  /// Random poses on the floor, outside the machines' rectangles, whose insides look alike when turned by 180
  /// degrees.
  Pose on_the_floor() {
    for (;;) {
      const Pose pose = test::random_pose(*walls, global->distance_field(), 0.5, 22.0, engine_);
      if (pose.x_m() < 61.0 || pose.y_m() < 37.0) return pose;
    }
  }

  static inline mapping::Walls* walls = nullptr;
  static inline GlobalLocalizer* global = nullptr;
  std::mt19937 engine_{31};
};

TEST_F(Global, FindsItselfOnAFactoryFloorAmongClutter) {
  constexpr int kPoses = 60;
  int found = 0;
  for (int i = 0; i < kPoses; ++i) {
    const Pose truth = on_the_floor();
    const GlobalAnswer answer = global->locate(scan_of(*walls, truth, 0.3, engine_));
    if (answer.state != GlobalState::Found) continue;
    EXPECT_TRUE(right(answer, truth)) << truth.x_m() << ' ' << truth.y_m() << ": wrong and confident";
    ++found;
  }
  EXPECT_GE(found, kPoses - 1);
}

TEST_F(Global, ARectangleLooksAlikeBothWaysRound) {
  const Pose truth(68.0, 45.0, 0.4);  // the offices: nothing but four walls
  const GlobalAnswer answer = global->locate(scan_of(*walls, truth, 0.2, engine_));
  EXPECT_EQ(answer.state, GlobalState::Ambiguous);
  ASSERT_GE(answer.hypotheses.size(), 2U);
  const Pose turned(2.0 * 70.8 - 68.0, 2.0 * 43.8 - 45.0, 0.4 + kPi);
  double probability = 0.0;
  for (const Hypothesis& h : answer.hypotheses)
    for (const Pose& p : {truth, turned})
      if (distance_m(h.fit.map_from_base.translation(), p.translation()) < 0.2) probability += h.probability;
  EXPECT_GT(probability, 0.95);
}

TEST_F(Global, AnotherBuildingIsSeldomTakenForThisOne) {
  int taken = 0;
  const mapping::Walls other = test::laboratory_hall();
  const mapping::DistanceField field(other);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = test::random_pose(other, field, 0.5, 5.0, engine_);
    const GlobalAnswer answer = global->locate(scan_of(other, pose, 0.2, engine_));
    taken += answer.state == GlobalState::Found;
    EXPECT_EQ(answer.reason.empty(), answer.state == GlobalState::Found);
  }
  EXPECT_LE(taken, 3);  // a plain rectangle of the other fits some corner here by chance
  EXPECT_EQ(global->locate({}).state, GlobalState::Nowhere);
}

TEST(GlobalWithTwins, AFewScansResolveWhatOneLeavesOpen) {
  mapping::Walls walls;  // two equal rooms off one corridor; only one has a pillar behind the corner
  test::add_box(walls, 0.0, 0.0, 30.0, 12.0);
  for (const double x : {6.0, 18.0}) {
    test::add_wall(walls, x, 0.0, x, 6.0);
    test::add_wall(walls, x + 6.0, 0.0, x + 6.0, 6.0);
    test::add_wall(walls, x, 6.0, x + 4.0, 6.0);
    test::add_wall(walls, x, 2.0, x + 1.5, 2.0);
  }
  const GlobalLocalizer global(walls);
  std::mt19937 engine(5);
  Pose truth(10.9, 4.0, -kPi / 2.0);  // the door is in the quarter that the lidar does not see
  GlobalAnswer answer = global.locate(scan_of(walls, truth, 0.0, engine));
  EXPECT_EQ(answer.state, GlobalState::Ambiguous);
  for (int scan = 0; scan < 35; ++scan) {  // it turns to the door and drives out
    const Transform2<Base, Base> moved =
        scan < 21 ? Transform2<Base, Base>(0.0, 0.0, 0.15) : Transform2<Base, Base>(0.25, 0.0, 0.0);
    truth = truth * moved;
    answer = global.locate(scan_of(walls, truth, 0.1, engine), answer, moved);
  }
  EXPECT_EQ(answer.state, GlobalState::Found);
  EXPECT_TRUE(right(answer, truth));
}

TEST(AbsoluteLocalization, BeatsThePapersTables) {
  const mapping::Walls walls = test::laboratory_hall();
  const GlobalLocalizer global(walls);
  const auto run = [&](double sigma_m, double clutter) {
    test::TrialSettings settings;
    settings.poses = 30;
    settings.sigma_m = sigma_m;
    settings.clutter = clutter;
    return test::run_trials(walls, global, settings, 77, [](auto&& locate) { locate(); });
  };
  for (const double sigma : {0.0, 0.1, 0.2, 0.3}) {
    const test::TrialResult r = run(sigma, 0.0);
    EXPECT_EQ(r.right, 30) << sigma;
    EXPECT_EQ(r.wrong_sure, 0) << sigma;
    EXPECT_LT(r.e_psr_mean_m, 0.01 + 0.85 * sigma) << sigma;
  }
  EXPECT_EQ(run(0.01, 0.15).right, 30);
}

TEST(ScanNoise, IsToldFromTheScanItself) {
  const mapping::Walls walls = test::laboratory_hall();
  const mapping::DistanceField field(walls);
  std::mt19937 engine(6);
  for (const double sigma : {0.1, 0.2, 0.3}) {
    ScanPoints scan = scan_points(test::simulate_scan(walls, {6.0, 5.5, 0.0}, {}, engine), {});
    std::normal_distribution<float> noise(0.0F, static_cast<float>(sigma));
    for (auto* array : {&scan.x_m, &scan.y_m})
      for (float& v : *array) v += noise(engine);
    EXPECT_NEAR(scan_noise_m(scan), sigma, 0.2 * sigma);
  }
  EXPECT_LT(scan_noise_m(scan_points(test::simulate_scan(walls, {6.0, 5.5, 0.0}, {}, engine), {})), 0.01);
  EXPECT_EQ(scan_noise_m({}), 0.0);
}

}  // namespace
}  // namespace madori::localization
