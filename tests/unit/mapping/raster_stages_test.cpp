// The stages of the wall detection, each on a picture drawn for it.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "mapping/drawing/raster/binarize.hpp"
#include "mapping/drawing/raster/columns.hpp"
#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/dashed_marks.hpp"
#include "mapping/drawing/raster/hough_seeds.hpp"
#include "mapping/drawing/raster/line_picture.hpp"
#include "mapping/drawing/raster/merge_lines.hpp"
#include "mapping/drawing/raster/pores.hpp"
#include "mapping/drawing/raster/refine_lines.hpp"
#include "mapping/drawing/raster/strips.hpp"
#include "mapping/drawing/raster/strokes.hpp"
#include "mapping/drawing/raster/text_marks.hpp"
#include "mapping/drawing/raster/thinning.hpp"
#include "mapping/drawing/raster/trace_chains.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {
namespace {

GrayImage blank(int width, int height, std::uint8_t value) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), value), 0};
}
cv::Mat canvas(GrayImage& image) {
  return {image.height_px, image.width_px, CV_8UC1, image.pixels.data()};
}

std::size_t count_ink(const GrayImage& image) {
  return static_cast<std::size_t>(
      std::count_if(image.pixels.begin(), image.pixels.end(), [](auto p) { return p != 0; }));
}

TEST(Binarize, FaintLinesBesideALargeFill) {
  GrayImage image = blank(400, 300, 255);
  cv::rectangle(canvas(image), {200, 0}, {399, 299}, 205, cv::FILLED);  // a tinted floor
  cv::line(canvas(image), {20, 20}, {180, 20}, 0, 2);
  cv::line(canvas(image), {220, 20}, {380, 20}, 0, 2);
  const Binarized result = binarize(image, std::nullopt);
  EXPECT_NE(result.ink.at(100, 20), 0);
  EXPECT_NE(result.ink.at(300, 20), 0);
  EXPECT_EQ(result.ink.at(300, 200), 0) << "the tint is no ink";
  GrayImage grey = blank(400, 300, 255);
  cv::line(canvas(grey), {20, 20}, {380, 20}, 200, 1);
  EXPECT_NE(binarize(grey, std::nullopt).ink.at(100, 20), 0) << "thin grey lines alone are the drawing";
}

TEST(Binarize, UnevenPaper) {
  GrayImage image = blank(600, 400, 255);
  for (int v = 0; v < 400; ++v)
    for (int u = 0; u < 600; ++u)
      canvas(image).at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(250 - u / 6);
  for (int u = 30; u < 600; u += 60) cv::rectangle(canvas(image), {u, 20}, {u + 2, 380}, 60, cv::FILLED);
  const Binarized result = binarize(image, std::nullopt);
  const auto share = static_cast<double>(count_ink(result.ink)) / (600.0 * 400);
  EXPECT_NEAR(share, 10 * 3 * 361 / (600.0 * 400), 1e-3);
}

TEST(Binarize, AFixedThresholdIsKept) {
  GrayImage image = blank(50, 50, 255);
  cv::line(canvas(image), {5, 25}, {45, 25}, 180, 3);
  EXPECT_EQ(count_ink(binarize(image, 150.0).ink), 0U);
  EXPECT_GT(count_ink(binarize(image, 200.0).ink), 100U);
}

/// Oracle: OpenCV's labelling of random dots.
TEST(Components, AreThoseOfOpenCv) {
  std::mt19937 random(3);
  GrayImage ink = blank(97, 61, 0);
  for (auto& pixel : ink.pixels) pixel = random() % 3 == 0 ? 255 : 0;
  cv::Mat labels;
  EXPECT_EQ(static_cast<int>(Components(ink).all().size()),
            cv::connectedComponents(canvas(ink), labels, 8) - 1);
  const cv::Mat paper = canvas(ink) == 0;
  EXPECT_EQ(static_cast<int>(Components(ink, true).all().size()),
            cv::connectedComponents(paper, labels, 4) - 1);
}

TEST(Components, DescribeABar) {
  GrayImage ink = blank(200, 200, 0);
  cv::line(canvas(ink), {40, 40}, {140, 140}, 255, 5);
  const Components marks(ink);
  ASSERT_EQ(marks.all().size(), 1U);
  EXPECT_NEAR(marks.all()[0].angle_rad, std::atan(1.0), 0.02);
  EXPECT_NEAR(marks.all()[0].long_px, 145, 5);
  EXPECT_GT(marks.all()[0].fill(), 0.85);
  EXPECT_EQ(marks.at(90, 90), 0);
  EXPECT_EQ(marks.at(10, 10), -1);
}

TEST(Thinning, KeepsOnePixelAndTheConnection) {
  GrayImage ink = blank(120, 80, 0);
  cv::line(canvas(ink), {10, 40}, {110, 40}, 255, 5);
  cv::line(canvas(ink), {60, 10}, {60, 70}, 255, 5);
  thin(ink);
  EXPECT_LT(count_ink(ink), 180U);
  cv::Mat labels;
  EXPECT_EQ(cv::connectedComponents(canvas(ink), labels, 8), 2);
}

TEST(Strokes, ThinSolidWallsAreNotThePen) {
  RunLengths runs(66, 0);
  for (const auto& [width, count] : {std::pair{2U, 900.0},
                                     {3U, 2400.0},
                                     {4U, 1600.0},
                                     {5U, 380.0},
                                     {6U, 310.0},
                                     {7U, 840.0},
                                     {8U, 1850.0},
                                     {9U, 210.0},
                                     {10U, 60.0},
                                     {11U, 20.0}})
    runs[width] = count;
  EXPECT_LE(solid_from_px(runs, pen_width_px(runs)), 7) << "walls of 8 pixels are solid";
  runs[7] = runs[8] = runs[9] = 0;
  EXPECT_GE(solid_from_px(runs, pen_width_px(runs)), 7) << "without them the emptiest thickness counts";
}

TEST(Strokes, SolidAndThinAreToldApart) {
  GrayImage ink = blank(300, 200, 0);
  for (int v = 20; v < 180; v += 20) cv::line(canvas(ink), {20, v}, {120, v}, 255, 2);
  cv::rectangle(canvas(ink), {150, 20}, {164, 180}, 255, cv::FILLED);
  const Components marks(ink);
  const RunLengths runs = run_lengths(ink, marks);
  EXPECT_NEAR(pen_width_px(runs), 2.5, 1.0);
  const Strokes strokes = split_strokes(ink, solid_from_px(runs, 2));
  EXPECT_NE(strokes.solid.at(157, 100), 0);
  EXPECT_EQ(strokes.solid.at(60, 40), 0);
  EXPECT_NE(strokes.thin.at(60, 40), 0);
}

TEST(Pores, OfDenseHatchingAreFilledAndRoomsAreNot) {
  GrayImage ink = blank(200, 100, 0);
  cv::rectangle(canvas(ink), {10, 10}, {190, 90}, 255, 1);
  cv::rectangle(canvas(ink), {30, 30}, {33, 33}, 255, 1);
  EXPECT_EQ(fill_pores(ink, 2), 1U);
  EXPECT_NE(ink.at(31, 31), 0);
  EXPECT_EQ(ink.at(100, 50), 0);
}

TEST(Lines, AreFittedBelowAPixelAcrossTilesAndCrossings) {
  GrayImage ink = blank(1400, 700, 0);
  constexpr double kSlope = 0.137;
  for (int u = 50; u < 1350; ++u)
    for (int k = -1; k <= 1; ++k)
      canvas(ink).at<std::uint8_t>(static_cast<int>(std::lround(80 + kSlope * u)) + k, u) = 255;
  cv::line(canvas(ink), {700, 20}, {700, 650}, 255, 3);
  Strokes strokes = split_strokes(ink, 8);
  GrayImage lines = line_picture(strokes);
  const DrawnLines found = refine_lines(lines, hough_seeds(lines, 20), {.shortest_px = 20});
  ASSERT_EQ(found.size(), 2U);
  const DrawnLine& longer = found[0].length_px() > found[1].length_px() ? found[0] : found[1];
  EXPECT_NEAR(longer.length_px(), 1300 * std::hypot(1, kSlope), 6);
  EXPECT_NEAR(std::tan(longer.angle_rad()), kSlope, 3e-4);
  const double v_at_middle = 0.5 * (longer.segment.v1 + longer.segment.v2);
  EXPECT_NEAR(v_at_middle, 80.5 + kSlope * (0.5 * (longer.segment.u1 + longer.segment.u2) - 0.5), 0.3);
}

TEST(Chains, ACurveBecomesAPolylineWithinAPixel) {
  GrayImage ink = blank(400, 400, 0);
  cv::circle(canvas(ink), {200, 200}, 150, kPenLine, 1);
  const auto chains = trace_chains(ink, 1.0, 4);
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_GE(chains[0].corners.size(), 12U);
  for (const LinePoint& p : chains[0].corners) EXPECT_NEAR(std::hypot(p.u - 200.5, p.v - 200.5), 150, 1.2);
}

DrawnLine line(double u1, double v1, double u2, double v2) {
  DrawnLine drawn;
  drawn.segment = {u1, v1, u2, v2};
  return drawn;
}

TEST(Merge, JoinsPiecesAndKeepsDoorsAndSecondFaces) {
  const DrawnLines merged = merge_lines(
      {line(0, 10, 100, 10), line(102, 10.4, 200, 10), line(0, 16, 200, 16), line(260, 10, 400, 10)}, {});
  ASSERT_EQ(merged.size(), 3U);
  EXPECT_NEAR(merged[0].length_px(), 200, 0.1);
}

TEST(Strips, HatchingCountsAsFilledAndEmptyDoesNot) {
  GrayImage ink = blank(400, 100, 0);
  for (const int v : {20, 32, 60, 72}) cv::line(canvas(ink), {20, v}, {380, v}, 255, 1);
  for (int u = 24; u < 370; u += 9) cv::line(canvas(ink), {u, 32}, {u + 8, 20}, 255, 1);
  const DrawnLines lines{line(20, 20.5, 380, 20.5), line(20, 32.5, 380, 32.5), line(20, 60.5, 380, 60.5),
                         line(20, 72.5, 380, 72.5)};
  const auto strips = find_strips(lines, ink, 20);
  ASSERT_EQ(strips.size(), 4U);
  for (const Strip& strip : strips) {
    EXPECT_NEAR(strip.width_px, 12, 0.1);
    EXPECT_NEAR(strip.length_px(), 360, 3);
    EXPECT_EQ(strip.ink_share > 0.9, strip.line < 2);
  }
  EXPECT_NEAR(measure_style(lines, strips, 1).thickness_px, 12, 1);
}

TEST(Text, IsARowOfSmallMarks) {
  GrayImage ink = blank(600, 300, 0);
  cv::putText(canvas(ink), "MACHINING 20089", {50, 100}, cv::FONT_HERSHEY_SIMPLEX, 1, 255, 2);
  cv::rectangle(canvas(ink), {50, 150}, {500, 280}, 255, 2);
  const Components marks(ink);
  const auto texts = find_text(marks, std::vector<bool>(marks.all().size(), false), 2, 3000);
  ASSERT_GE(texts.size(), 1U);
  EXPECT_NEAR(texts[0].angle_rad, 0, 0.1);
  for (const auto& text : texts)
    for (const std::size_t i : text.marks) EXPECT_LT(marks.all()[i].size(), 60);
}

TEST(Dashed, EvenBarsAreALineAndAWallWithDoorsIsNot) {
  GrayImage ink = blank(800, 200, 0);
  for (int u = 20; u < 700; u += 40) cv::rectangle(canvas(ink), {u, 50}, {u + 25, 52}, 255, cv::FILLED);
  for (const int u : {20, 180, 300, 600})
    cv::rectangle(canvas(ink), {u, 120}, {u + 90, 126}, 255, cv::FILLED);
  const Components marks(ink);
  const auto dashed = find_dashed(marks, 3);
  ASSERT_EQ(dashed.size(), 1U);
  EXPECT_EQ(dashed[0].size(), 17U);
}

TEST(Dashed, ALongLineThatEndsInDotsIsNone) {
  GrayImage ink = blank(800, 100, 0);
  cv::rectangle(canvas(ink), {20, 50}, {600, 52}, 255, cv::FILLED);
  for (int u = 606; u < 624; u += 6) cv::rectangle(canvas(ink), {u, 50}, {u + 2, 52}, 255, cv::FILLED);
  EXPECT_TRUE(find_dashed(Components(ink), 3).empty());
}

TEST(Columns, StandOnDashedAxesAndNotInWords) {
  GrayImage ink = blank(900, 300, 0);
  for (const int u : {50, 250, 450, 650, 850}) {
    cv::rectangle(canvas(ink), {u, 50}, {u + 19, 69}, 255, cv::FILLED);  // pillars ...
    cv::rectangle(canvas(ink), {u - 24, 59}, {u - 6, 60}, 255,
                  cv::FILLED);                                             // ... each with a dash of its axis
    cv::rectangle(canvas(ink), {u, 200}, {u + 19, 219}, 255, cv::FILLED);  // an R with its holes filled ...
    cv::putText(canvas(ink), "M", {u + 23, 219}, cv::FONT_HERSHEY_SIMPLEX, 0.9, 255, 2);  // ... before an M
  }
  const Components marks(ink);
  const auto columns = find_columns(marks, std::vector<bool>(marks.all().size(), false), 3);
  ASSERT_EQ(columns.size(), 5U);
  for (const Column& column : columns) EXPECT_LT(column.faces[0].v1, 100);
}

}  // namespace
}  // namespace madori::mapping
