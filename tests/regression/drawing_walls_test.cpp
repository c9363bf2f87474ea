// Wall detection on real drawings with hand-made truth, at 0.15 m. The floors below are what the detection
// reaches, a little rounded down; tests/bench/score_walls.py prints the exact table beside the baselines.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "mapping/drawing/read_drawing.hpp"
#include "mapping/picture/load_image.hpp"
#include "tests/support/wall_score.hpp"

namespace madori::mapping {
namespace {

struct Case {
  std::string name, picture, truth;
  double m_per_px, least_f1;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class DrawingWalls : public ::testing::TestWithParam<Case> {};

TEST_P(DrawingWalls, ReachTheirScore) {
  const Case& c = GetParam();
  if (!std::filesystem::exists(c.picture)) GTEST_SKIP() << c.picture << " is not there";
  const DetectedWalls found = read_drawing(load_image(c.picture), {});
  const auto score = test::score_walls(found.walls, test::read_true_walls(c.truth), 0.15 / c.m_per_px);
  RecordProperty("f1", std::to_string(score.f1()));
  EXPECT_GE(score.f1(), c.least_f1) << "precision " << score.precision << ", recall " << score.recall;
  EXPECT_LE(score.detected_px, 2.2 * score.truth_px) << "walls are found twice";
}

Case shared(const std::string& name, double m_per_px, double least_f1) {
  const std::string folder = std::string(MADORI_SHARED_DATA) + "/drawings/" + name + "/";
  return {name, folder + name + ".png", folder + "walls.csv", m_per_px, least_f1};
}

const std::string kFactory = std::string(MADORI_SOURCE_DIR) + "/data/sample_factory/";

INSTANTIATE_TEST_SUITE_P(
    Drawings, DrawingWalls,
    ::testing::Values(Case{"factory", kFactory + "factory_scan.png", kFactory + "true_walls_scan_px.csv",
                           0.025, 0.98},
                      shared("office", 0.00846, 0.97), shared("clinic", 0.02692, 0.77),
                      // marked beside its walls by about the tolerance, see docs/reference/drawings.md
                      shared("hotel_L1", 0.05568, 0.68), shared("mlstruct_7db30954", 0.00474825, 0.99),
                      shared("mlstruct_8888a588", 0.00272847, 0.99)),
    [](const auto& test) { return test.param.name; });

/// The lines of this layout are what a later localization matches against: its four outer and inner sides,
/// the core, the slanted corner and the curved walls must all be there.
TEST(DrawingWalls, TheIntelLayoutIsComplete) {
  const std::string picture = std::string(MADORI_SHARED_DATA) + "/lidar2d/intel/layout.png";
  if (!std::filesystem::exists(picture)) GTEST_SKIP() << picture << " is not there";
  const DetectedWalls found = read_drawing(load_image(picture), {});
  double length = 0;
  const std::vector<PixelSegment> faces{{50, 22, 712, 22},    {50, 22, 50, 685},    {180, 232, 180, 526},
                                        {712, 22, 712, 515},  {50, 685, 542, 685},  {712, 515, 542, 685},
                                        {268, 202, 470, 202}, {254, 227, 416, 227}, {222, 155, 268, 149},
                                        {268, 149, 325, 147}, {410, 155, 470, 165}, {395, 372, 395, 507}};
  EXPECT_GT(test::matched_share(faces, found.walls, 3.0, length), 0.93);
}

}  // namespace
}  // namespace madori::mapping
