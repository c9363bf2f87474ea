// Edges, what is known of them, and the model that judges them.
#include "mapping/drawing/labelling/label_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

GrayImage paper(int width, int height, int level = 255) {
  return {
      width, height,
      std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), static_cast<std::uint8_t>(level)),
      0};
}
cv::Mat canvas(GrayImage& image) {
  return {image.height_px, image.width_px, CV_8UC1, image.pixels.data()};
}

const Edge* longest_near(const EdgeSheet& sheet, double v) {
  const Edge* best = nullptr;
  for (const Edge& edge : sheet.edges) {
    const double off = 0.5 * (edge.segment.v1 + edge.segment.v2) / sheet.factor - v;
    if (std::abs(off) < 1.5 && (best == nullptr || edge.length_px > best->length_px)) best = &edge;
  }
  return best;
}

TEST(EdgeSheet, BothSidesOfABarPointInwards) {
  GrayImage image = paper(600, 400);
  cv::rectangle(canvas(image), {100, 100}, {499, 119}, 0, cv::FILLED);
  const EdgeSheet sheet = find_edges(image);
  const Edge *upper = longest_near(sheet, 100), *lower = longest_near(sheet, 120);
  ASSERT_NE(upper, nullptr);
  ASSERT_NE(lower, nullptr);
  EXPECT_GT(upper->length_px, 380 * sheet.factor);
  EXPECT_GT(upper->normal_v, 0.99) << "the dark side is below";
  EXPECT_LT(lower->normal_v, -0.99) << "the dark side is above";
}

TEST(EdgeViews, MeetTheOtherSideOfABar) {
  GrayImage image = paper(600, 400);
  cv::rectangle(canvas(image), {100, 100}, {499, 119}, 0, cv::FILLED);
  const EdgeSheet sheet = find_edges(image);
  const auto views = look_across(sheet);
  const Edge* upper = longest_near(sheet, 100);
  ASSERT_NE(upper, nullptr);
  const EdgeViews& view = views[static_cast<std::size_t>(upper - sheet.edges.data())];
  EXPECT_NEAR(view.dark.hits[0].distance_px, 20 * sheet.factor, 2);
  EXPECT_GT(view.dark.hits[0].opposite, 0.9);
  EXPECT_LT(view.dark.fill_grey, 30);
  EXPECT_EQ(view.bright.hits[0].share, 0) << "there is nothing above it";
  EXPECT_GT(view.bright.near_grey, 220);
}

TEST(EdgeFeatures, HaveNamesOfTheirOwnAndAreFinite) {
  GrayImage image = paper(500, 400);
  cv::rectangle(canvas(image), {60, 60}, {440, 340}, 0, 3);
  cv::circle(canvas(image), {250, 200}, 60, 90, 2);
  const LabelSheet sheet = label_sheet(image, {}, 1, 1);
  const auto& names = sheet.features.names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  ASSERT_GT(sheet.features.rows(), 8U);
  for (std::size_t row = 0; row < sheet.features.rows(); ++row)
    for (std::size_t column = 0; column < names.size(); ++column)
      ASSERT_TRUE(std::isfinite(sheet.features.at(row, column))) << names[column];
}

TEST(WallModel, RefusesWhatIsNoModelAndOtherFeatures) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)WallModel::load("/no/such/model"), Error);
  EXPECT_THROW((void)WallModel::load(folder.write("model.ubj", "not trees")), Error);
  FeatureTable other(1);
  other.add("something", {1.0F});
  EXPECT_THROW((void)WallModel::shipped().probabilities(other), Error);
}

/// Rooms by single lines in a grey that the binarization takes for paper beside black text: kept all the
/// same.
TEST(LabelLines, EdgesWithoutInkBecomeLines) {
  GrayImage image = paper(900, 700);
  cv::Mat picture = canvas(image);
  cv::rectangle(picture, {100, 100}, {800, 600}, 190, 3);
  const LabelSheet sheet = label_sheet(image, {}, 1, 1);
  const DrawnLines lines = label_lines(sheet, WallModel::shipped().probabilities(sheet.features), {}, 1, 1);
  double length = 0;
  for (const DrawnLine& line : lines) {
    EXPECT_GE(line.probability, 0);
    EXPECT_LE(line.probability, 1);
    length += line.length_px();
  }
  EXPECT_GT(length, 2 * 2300) << "both sides of every line are there, however improbable";
}

/// A line is cut where its edges change from wall to something else.
TEST(LabelLines, TheProbabilityOfALineIsThatOfItsEdges) {
  GrayImage image = paper(900, 700);
  cv::rectangle(canvas(image), {100, 100}, {800, 600}, 0, 3);
  DrawnLine line;
  line.segment = {100, 100.5, 800, 100.5};
  line.stroke_px = 3;
  DrawnLine nowhere = line;
  nowhere.segment = {300, 300, 500, 300};
  const DrawnLines drawn{line, nowhere};
  const LabelSheet sheet = label_sheet(image, drawn, 1, 1);
  const auto probabilities = WallModel::shipped().probabilities(sheet.features);
  const auto [least, most] = std::minmax_element(probabilities.begin(), probabilities.end());
  const DrawnLines lines = label_lines(sheet, probabilities, drawn, 1, 1);
  ASSERT_GE(lines.size(), 2U);
  EXPECT_GE(lines.front().probability, *least);
  EXPECT_LE(lines.front().probability, *most);
  const auto unseen = std::find_if(lines.begin(), lines.end(),
                                   [](const DrawnLine& l) { return l.segment.v1 == 300 && !l.pale; });
  ASSERT_NE(unseen, lines.end());
  EXPECT_EQ(unseen->probability, 0) << "no edge runs there";
}

}  // namespace
}  // namespace madori::mapping
