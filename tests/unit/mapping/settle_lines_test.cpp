#include "mapping/drawing/raster/settle_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "mapping/drawing/raster/edge_profile.hpp"
#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/read_drawing.hpp"

namespace madori::mapping {
namespace {

constexpr int kSide = 160;
constexpr double kClose = 0.12;  // pixels
constexpr int kFiner = 8;        // samples a pixel and direction

/// A picture of what `is_ink` says of every place, each pixel as grey as it is covered.
GrayImage painted(const std::function<bool(double u, double v)>& is_ink, int ink = 0, int paper = 255) {
  GrayImage image{kSide, kSide, {}, 0};
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u) {
      int covered = 0;
      for (int row = 0; row < kFiner; ++row)
        for (int column = 0; column < kFiner; ++column)
          covered += is_ink(u + (column + 0.5) / kFiner, v + (row + 0.5) / kFiner) ? 1 : 0;
      const double share = static_cast<double>(covered) / (kFiner * kFiner);
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(std::lerp(paper, ink, share))));
    }
  return image;
}

FittedLine axis_at(double u, double v, double angle_rad) {
  return {{u, v}, {std::cos(angle_rad), std::sin(angle_rad)}};
}

/// A line 120 long about the axis, `off` beside it at its beginning and `off + turn` at its end.
DrawnLine line_beside(const FittedLine& axis, double off, double turn) {
  const cv::Point2d from = axis.at(-60, off), to = axis.at(60, off + turn);
  DrawnLine line;
  line.segment = {from.x, from.y, to.x, to.y};
  return line;
}

double furthest_px(const DrawnLine& line, const FittedLine& truth) {
  const PixelSegment& s = line.segment;
  return std::max(std::abs(truth.across(s.u1, s.v1)), std::abs(truth.across(s.u2, s.v2)));
}

DrawnLine settled(DrawnLine line, const GreyDrawing& drawing) {
  DrawnLines lines{std::move(line)};
  settle_lines(lines, drawing);
  return lines.front();
}

TEST(SettleLines, StrokesOfAnyWidthPlaceAndDirectionComeToTheirMiddle) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(70, 90), angle(0, std::numbers::pi), off(-0.7, 0.7);
  for (int round = 0; round < 40; ++round) {
    const double half = 0.5 * (1 + round % 7), at_u = place(random), at_v = place(random);
    const FittedLine truth = axis_at(at_u, at_v, angle(random));
    const GrayImage image =
        painted([&](double u, double v) { return std::abs(truth.across(u, v)) <= half; }, 40, 230);
    DrawnLine line = line_beside(truth, off(random), 0.5 * off(random));
    line.stroke_px = 2 * half;
    EXPECT_LT(furthest_px(settled(line, {image}), truth), kClose) << "round " << round;
  }
}

TEST(SettleLines, FacesOfFillsComeToTheEdgeOfTheInk) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(70, 90), angle(0, std::numbers::pi), off(-0.8, 0.8);
  for (int round = 0; round < 40; ++round) {
    const double at_u = place(random), at_v = place(random);
    const FittedLine truth = axis_at(at_u, at_v, angle(random));
    const auto fill = [&](double u, double v) { return truth.across(u, v) > 0 && truth.across(u, v) < 12; };
    DrawnLine line = line_beside(truth, off(random), 0.4 * off(random));
    line.solid_face = true;
    EXPECT_LT(furthest_px(settled(line, {painted(fill)}), truth), kClose) << "round " << round;
    EXPECT_LT(furthest_px(settled(line, {painted(fill, 255, 0), {1, 1}, true}), truth), kClose) << round;
  }
}

TEST(SettleLines, HatchingAndCrossingsOnOneSideDoNotPullALine) {
  const FittedLine truth = axis_at(80, 80.3, 0);
  const GrayImage image = painted([&](double u, double v) {
    const double across = truth.across(u, v);
    const bool hatch = across > 0 && across < 14 && std::fmod(u + v, 9.0) < 2;
    return std::abs(across) <= 1.5 || hatch || std::abs(u - 60) < 1;
  });
  DrawnLine line = line_beside(truth, 0.5, 0);
  line.stroke_px = 3;
  EXPECT_LT(furthest_px(settled(line, {image}), truth), 0.12);
}

TEST(SettleLines, LinesInAnotherResolutionAreSettledOnTheDrawing) {
  const FittedLine truth = axis_at(80.2, 79.6, 0.3);
  const GrayImage image = painted([&](double u, double v) { return std::abs(truth.across(u, v)) <= 4; });
  for (const double scale : {0.5, 2.0, 3.0}) {  // pixels of the drawing for one of the lines
    DrawnLine line = line_beside(truth, 0.6 * scale, 0);
    PixelSegment& s = line.segment;
    s = {s.u1 / scale, s.v1 / scale, s.u2 / scale, s.v2 / scale};
    line.stroke_px = 8 / scale;
    DrawnLine found = settled(line, {image, {scale, scale}});
    PixelSegment& f = found.segment;
    f = {f.u1 * scale, f.v1 * scale, f.u2 * scale, f.v2 * scale};
    EXPECT_LT(furthest_px(found, truth), 0.08) << scale;
  }
}

TEST(SettleLines, WithoutAClearEdgeALineStays) {
  const FittedLine truth = axis_at(80, 80, 0.2);
  const DrawnLine line = line_beside(truth, 0.4, 0);
  const GrayImage empty = painted([](double, double) { return false; });
  EXPECT_EQ(settled(line, {empty}).segment, line.segment);
  const GrayImage far =
      painted([&](double u, double v) { return std::abs(truth.across(u, v) - 2.6) <= 0.8; });
  EXPECT_EQ(settled(line, {far}).segment, line.segment) << "another line";
  const GrayImage own = painted([&](double u, double v) { return std::abs(truth.across(u, v)) <= 0.8; });
  DrawnLine rejected = line;
  rejected.rejected = RejectReason::Hatch;
  EXPECT_EQ(settled(rejected, {own}).segment, line.segment);
  EXPECT_NE(settled(line, {own}).segment, line.segment);
}

TEST(EdgeProfile, FindsTheCrossingNearestToTheLineAndItsSide) {
  const EdgeProfile profile{{0, 0, 0, 50, 150, 200, 200, 200}, -3, 1};
  const auto place = face_place(profile, 1.5);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->offset_px, 0.5, 1e-6);
  EXPECT_TRUE(place->ink_follows);
  EXPECT_FALSE(face_place(profile, 0.4));
  EXPECT_FALSE(face_place({{100, 101, 100}, -1, 1}, 1.5)) << "no contrast";
  EXPECT_FALSE(stroke_place(profile, 1.5, 2)) << "one flank only";
}

/// The law behind it: what is drawn from edge to edge comes out at those edges, however it is found.
TEST(SettleLines, SolidWallsComeOutAtTheirEdges) {
  GrayImage image{600, 500, std::vector<std::uint8_t>(600 * 500, 255), 0};
  const auto fill = [&](int u0, int v0, int u1, int v1) {
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u)
        image.pixels[static_cast<std::size_t>(v) * 600 + static_cast<std::size_t>(u)] = 0;
  };
  fill(50, 50, 550, 66);
  fill(50, 434, 550, 450);
  fill(50, 50, 66, 450);
  fill(534, 50, 550, 450);
  fill(300, 66, 312, 300);
  const DetectedWalls found = read_drawing(image, {});
  int upright = 0;
  for (const PixelSegment& s : found.walls) {
    if (std::abs(s.v2 - s.v1) < 100) continue;
    double nearest = 1e9;
    for (const double edge : {50.0, 66.0, 300.0, 312.0, 534.0, 550.0})
      nearest = std::min(nearest, std::abs(0.5 * (s.u1 + s.u2) - edge));
    EXPECT_LT(nearest, 0.05) << s.u1;
    ++upright;
  }
  EXPECT_EQ(upright, 6);
}

}  // namespace
}  // namespace madori::mapping
