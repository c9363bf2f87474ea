// Whole drawings, small: what must come out as walls and what must not.
#include "mapping/drawing/read_drawing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/result.hpp"
#include "tests/support/paper_image.hpp"

namespace madori::mapping {
namespace {

using test::canvas;
using test::paper;

/// A room with double walls, a dividing wall with a door, a chair, a dashed line and a label.
GrayImage small_plan() {
  GrayImage image = paper(1200, 900);
  cv::Mat picture = canvas(image);
  cv::rectangle(picture, {100, 100}, {1100, 800}, 0, 2);
  cv::rectangle(picture, {114, 114}, {1086, 786}, 0, 2);
  for (const int u : {593, 607}) {
    cv::line(picture, {u, 114}, {u, 400}, 0, 2);
    cv::line(picture, {u, 500}, {u, 786}, 0, 2);
  }
  cv::line(picture, {593, 400}, {607, 400}, 0, 2);
  cv::line(picture, {593, 500}, {607, 500}, 0, 2);
  cv::rectangle(picture, {250, 300}, {290, 340}, 0, 2);
  for (int u = 700; u < 1000; u += 50) cv::line(picture, {u, 650}, {u + 30, 650}, 0, 2);
  cv::putText(picture, "OFFICE", {750, 300}, cv::FONT_HERSHEY_SIMPLEX, 1, 0, 2);
  return image;
}

/// Length of walls within 2 pixels of the straight line from a to b.
double covered(const DetectedWalls& found, cv::Point2d a, cv::Point2d b) {
  double length = 0;
  const cv::Point2d axis = (b - a) / cv::norm(b - a);
  for (const PixelSegment& s : found.walls) {
    const cv::Point2d p = cv::Point2d(s.u1, s.v1) - a, q = cv::Point2d(s.u2, s.v2) - a;
    if (std::max(std::abs(axis.cross(p)), std::abs(axis.cross(q))) > 2) continue;
    const double from = std::min(axis.dot(p), axis.dot(q)), to = std::max(axis.dot(p), axis.dot(q));
    length += std::max(0.0, std::min(to, cv::norm(b - a)) - std::max(from, 0.0));
  }
  return length;
}

bool any_inside(const DetectedWalls& found, double u0, double v0, double u1, double v1) {
  return std::any_of(found.walls.begin(), found.walls.end(), [&](const PixelSegment& s) {
    const double u = 0.5 * (s.u1 + s.u2), v = 0.5 * (s.v1 + s.v2);
    return u > u0 && u < u1 && v > v0 && v < v1;
  });
}

TEST(ReadDrawing, IsTheSameOnAnyNumberOfThreads) {
  const GrayImage plan = small_plan();
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const DetectedWalls one = read_drawing(plan, {});
  for (const int several : {2, 5}) {
    cv::setNumThreads(several);
    const DetectedWalls found = read_drawing(plan, {});
    EXPECT_EQ(found.walls, one.walls) << several;
    EXPECT_EQ(found.probabilities, one.probabilities) << several;
    EXPECT_EQ(found.rejected.size(), one.rejected.size()) << several;
  }
  cv::setNumThreads(threads);
}

TEST(ReadDrawing, BothFacesStayAndTheDoorStaysOpen) {
  const DetectedWalls found = read_drawing(small_plan(), {});
  EXPECT_GT(covered(found, {114, 114}, {1086, 114}), 940);
  EXPECT_GT(covered(found, {100, 100}, {1100, 100}), 970);
  for (const double u : {593.0, 607.0}) {
    EXPECT_GT(covered(found, {u, 114}, {u, 400}), 270);
    EXPECT_LT(covered(found, {u, 405}, {u, 495}), 5);
  }
  EXPECT_NEAR(found.skew_deg, 0, 0.05);
}

TEST(ReadDrawing, ChairsDashesAndTextAreNone) {
  const DetectedWalls found = read_drawing(small_plan(), {});
  EXPECT_FALSE(any_inside(found, 230, 280, 310, 360)) << "a chair";
  EXPECT_FALSE(any_inside(found, 680, 630, 1010, 670)) << "a dashed line";
  EXPECT_FALSE(any_inside(found, 740, 260, 900, 320)) << "a label";
  DetectionOptions keep;
  keep.strictness = 0;
  const DetectedWalls all = read_drawing(small_plan(), keep);
  EXPECT_TRUE(any_inside(all, 230, 280, 310, 360));
  EXPECT_TRUE(any_inside(all, 680, 630, 1010, 670));
}

TEST(ReadDrawing, ASolidWallHasTwoFaces) {
  GrayImage image = paper(1000, 700);
  cv::rectangle(canvas(image), {100, 100}, {900, 120}, 60, cv::FILLED);
  cv::rectangle(canvas(image), {100, 100}, {120, 600}, 60, cv::FILLED);
  const DetectedWalls found = read_drawing(image, {});
  EXPECT_GT(covered(found, {120, 120.5}, {900, 120.5}), 760);
  EXPECT_GT(covered(found, {100, 100.5}, {900, 100.5}), 780);
}

double total_length(const DetectedWalls& found) {
  double length = 0;
  for (const PixelSegment& wall : found.walls) length += wall.length_px();
  return length;
}

/// A CAD screen or a blueprint: the same walls.
TEST(ReadDrawing, BrightLinesOnADarkGround) {
  const GrayImage plan = small_plan();
  GrayImage screen = plan;
  for (auto& pixel : screen.pixels) pixel = static_cast<std::uint8_t>(230 - pixel / 255 * 200);
  const auto dark = read_drawing(plan, {}), bright = read_drawing(screen, {});
  ASSERT_EQ(bright.walls.size(), dark.walls.size());
  for (std::size_t i = 0; i < dark.walls.size(); ++i) {
    const PixelSegment &one = bright.walls[i], &other = dark.walls[i];
    EXPECT_LT(std::hypot(one.u1 - other.u1, one.v1 - other.v1), 0.01);
    EXPECT_LT(std::hypot(one.u2 - other.u2, one.v2 - other.v2), 0.01);
  }
}

/// However fine a drawing is scanned, its walls are the same and come in its own pixels.
TEST(ReadDrawing, ResolutionDoesNotMatter) {
  const GrayImage plan = small_plan();
  for (const double factor : {0.5, 2.0, 3.0}) {
    GrayImage other =
        paper(static_cast<int>(plan.width_px * factor), static_cast<int>(plan.height_px * factor));
    cv::resize(cv::Mat(plan.height_px, plan.width_px, CV_8UC1, const_cast<std::uint8_t*>(plan.pixels.data())),
               canvas(other), {other.width_px, other.height_px}, 0, 0, cv::INTER_AREA);
    const auto found = read_drawing(other, {});
    // 970 pixels, less the end of the dividing wall where no face can be seen
    for (const double v : {100.5, 114.5, 786.5, 800.5})
      EXPECT_GT(covered(found, cv::Point2d(115, v) * factor, cv::Point2d(1085, v) * factor), 940 * factor)
          << "v = " << v << ", factor " << factor;
    // at half the size the chair (4 x 40 pixels) is doubtful and taken
    EXPECT_NEAR(total_length(found), factor * total_length(read_drawing(plan, {})), 200 * factor);
  }
}

/// A wrong file, a broken scanner: said in one line, and soon.
TEST(ReadDrawing, NoiseIsRefused) {
  for (const auto& [width, height] : {std::pair{700, 500}, {2102, 1485}}) {
    GrayImage image = paper(width, height);
    std::mt19937 engine(1);
    for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(engine() >> 24U);
    EXPECT_THROW((void)read_drawing(image, {}), Error) << width;
  }
}

TEST(ReadDrawing, BlankPaperHoldsNothing) {
  for (const int level : {0, 128, 255}) {
    GrayImage image = paper(300, 200);
    std::fill(image.pixels.begin(), image.pixels.end(), static_cast<std::uint8_t>(level));
    EXPECT_TRUE(read_drawing(image, {}).walls.empty()) << level;
  }
}

TEST(ReadDrawing, TinyPicturesAreNoTrouble) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {2, 2}, {3, 5}, {7, 1}}) {
    GrayImage image = paper(width, height);
    image.pixels[0] = 0;
    EXPECT_TRUE(read_drawing(image, {}).walls.empty());
  }
}

TEST(ReadDrawing, RefusesNonsense) {
  EXPECT_THROW(static_cast<void>(read_drawing({}, {})), Error);
  DetectionOptions options;
  options.strictness = -1;
  EXPECT_FALSE(options.is_valid());
  EXPECT_THROW(static_cast<void>(read_drawing(small_plan(), options)), Error);
}

TEST(ReadDrawing, StagesAndProgressAreReported) {
  std::vector<std::string> pictures;
  double last = -1;
  const auto found = read_drawing(
      small_plan(), {}, [&](const std::string& stage, const GrayImage&) { pictures.push_back(stage); },
      [&](const std::string&, double share) {
        EXPECT_GE(share, last);
        last = share;
      });
  EXPECT_EQ(pictures, (std::vector<std::string>{"greys", "edges", "judged"}));
  EXPECT_EQ(last, 1);
  EXPECT_EQ(found.stages.size(), 5U);
}

}  // namespace
}  // namespace madori::mapping
