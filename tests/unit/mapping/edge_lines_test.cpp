// Edges become lines: strokes by their middle, bodies by their faces.
#include "mapping/drawing/labelling/edge_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/merge_lines.hpp"
#include "tests/support/paper_image.hpp"

namespace madori::mapping {
namespace {

using test::canvas;
using test::paper;

DrawnLine line(double u1, double v1, double u2, double v2) {
  DrawnLine drawn;
  drawn.segment = {u1, v1, u2, v2};
  return drawn;
}

TEST(Merge, JoinsPiecesAndKeepsDoorsAndSecondFaces) {
  const DrawnLines merged = merge_lines(
      {line(0, 10, 100, 10), line(102, 10.4, 200, 10), line(0, 16, 200, 16), line(260, 10, 400, 10)}, 4);
  ASSERT_EQ(merged.size(), 3U);
  EXPECT_NEAR(merged[0].length_px(), 200, 0.1);
}

TEST(Merge, ProbabilitiesAreMeansByLengthAndWallsStayApartFromOthers) {
  DrawnLine sure = line(0, 10, 300, 10), less = line(300, 10, 400, 10), none = line(400, 10, 500, 10);
  sure.probability = 0.9, less.probability = 0.5, none.probability = 0.1;
  none.rejected = RejectReason::Other;
  const DrawnLines merged = merge_lines({sure, less, none}, 4);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_NEAR(merged[0].probability, 0.8, 1e-9);
  EXPECT_NEAR(merged[0].length_px(), 400, 1e-9);
}

/// What `probability` says of a place of the drawing, for each edge.
template <class Probability>
DrawnLines lines_of(const GrayImage& image, Probability probability, double& factor) {
  const LabelSheet sheet = label_sheet(find_edges(image));
  factor = sheet.edges.factor;
  std::vector<float> p;
  for (const Edge& edge : sheet.edges.edges) {
    const PixelSegment& s = edge.segment;
    p.push_back(static_cast<float>(probability(0.5 * (s.u1 + s.u2) / factor, 0.5 * (s.v1 + s.v2) / factor)));
  }
  const EdgeStrokes strokes(sheet);
  return strokes.lines(strokes.together(p), 0.5, std::nullopt);
}

/// Lines that are `want` walls, along v = `at` of the drawing within a pixel: their length in its pixels.
double length_at(const DrawnLines& lines, double at, bool want, double factor) {
  double length = 0;
  for (const DrawnLine& l : lines)
    if (std::max(std::abs(l.segment.v1 / factor - at), std::abs(l.segment.v2 / factor - at)) < 1 &&
        want == !l.rejected)
      length += l.length_px() / factor;
  return length;
}

TEST(EdgeLines, AStrokeIsOneLineAndABodyHasTwoFaces) {
  GrayImage image = paper(1200, 900);
  for (const int v : {100, 200, 300, 400, 500, 600})
    cv::rectangle(canvas(image), {100, v}, {1099, v + 3}, 0, cv::FILLED);
  cv::rectangle(canvas(image), {100, 700}, {1099, 729}, 0, cv::FILLED);
  double factor = 1;
  const DrawnLines lines = lines_of(
      image, [](double, double) { return 0.8; }, factor);
  for (const double v : {102.0, 302.0, 602.0}) EXPECT_NEAR(length_at(lines, v, true, factor), 1000, 8) << v;
  for (const double v : {700.0, 730.0}) EXPECT_NEAR(length_at(lines, v, true, factor), 1000, 8) << v;
  for (const DrawnLine& l : lines) EXPECT_NEAR(l.probability, 0.8, 1e-6);
}

TEST(EdgeLines, CrossingsDoNotInterruptALineAndDoorsDo) {
  GrayImage image = paper(1200, 900);
  const auto bar = [&](int u0, int v0, int u1, int v1) {
    cv::rectangle(canvas(image), {u0, v0}, {u1, v1}, 0, cv::FILLED);
  };
  bar(100, 300, 499, 303), bar(600, 300, 1099, 303);            // a door of 100
  for (const int u : {200, 350, 800}) bar(u, 100, u + 3, 700);  // strokes that cross
  double factor = 1;
  const DrawnLines lines = lines_of(
      image, [](double, double) { return 0.8; }, factor);
  std::vector<double> lengths;
  for (const DrawnLine& l : lines)
    if (std::abs(l.segment.v1 / factor - 302) < 1 && std::abs(l.segment.v2 / factor - 302) < 1)
      lengths.push_back(l.length_px() / factor);
  std::sort(lengths.begin(), lengths.end());
  ASSERT_EQ(lengths.size(), 2U);
  EXPECT_NEAR(lengths[0], 400, 5);
  EXPECT_NEAR(lengths[1], 500, 5);
}

TEST(EdgeLines, PaleLinesAreKeptHoweverImprobable) {
  GrayImage image = paper(900, 700);
  cv::line(canvas(image), {100, 100}, {800, 100}, 0, 3);
  cv::line(canvas(image), {100, 500}, {800, 500}, 190, 3);
  double factor = 1;
  const DrawnLines lines = lines_of(
      image, [](double, double v) { return v < 300 ? 0.9 : 0.02; }, factor);
  EXPECT_NEAR(length_at(lines, 100.5, true, factor), 700, 10);
  EXPECT_NEAR(length_at(lines, 500.5, false, factor), 700, 10);
}

}  // namespace
}  // namespace madori::mapping
