// One plan, turned, resized and drawn with thicker strokes: its walls stay its walls.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "mapping/drawing/read_drawing.hpp"
#include "tests/support/wall_score.hpp"

namespace madori::mapping {
namespace {

/// 1200 x 900 pixels: solid outer walls of 20, inner walls of 12, chairs and a label.
constexpr int kWidth = 1200, kHeight = 900;

/// Both faces of the outer walls, the middles of the inner ones.
std::vector<PixelSegment> true_faces() {
  return {{100, 100, 1100, 100}, {1100, 100, 1100, 800}, {1100, 800, 100, 800}, {100, 800, 100, 100},
          {120, 120, 1080, 120}, {1080, 120, 1080, 780}, {1080, 780, 120, 780}, {120, 780, 120, 120},
          {500, 120, 500, 400},  {500, 520, 500, 780},   {500, 300, 1080, 300}, {800, 300, 800, 600}};
}

cv::Mat draw() {
  cv::Mat picture(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
  const auto bar = [&](int u1, int v1, int u2, int v2) {
    cv::rectangle(picture, {u1, v1}, {u2 - 1, v2 - 1}, 0, cv::FILLED);
  };
  bar(100, 100, 1100, 120), bar(100, 780, 1100, 800), bar(100, 100, 120, 800), bar(1080, 100, 1100, 800);
  bar(494, 120, 506, 400), bar(494, 520, 506, 780), bar(500, 294, 1080, 306), bar(794, 300, 806, 600);
  for (const int u : {180, 260, 340, 600, 680, 900, 980}) {
    cv::rectangle(picture, {u, 640}, {u + 36, 676}, 0, 2);
    cv::circle(picture, {u + 18, 700}, 14, 0, 2);
  }
  cv::putText(picture, "OFFICE", {560, 220}, cv::FONT_HERSHEY_SIMPLEX, 1, 0, 2, cv::LINE_AA);
  return picture;
}

struct Shape {
  const char* name;
  double degrees, factor;
  int thicker_px;
};

/// Where a point of the plan lies in the turned and resized picture.
cv::Mat transform(const Shape& shape, cv::Size& size) {
  const double angle = shape.degrees * CV_PI / 180, c = std::abs(std::cos(angle)),
               s = std::abs(std::sin(angle));
  size = {static_cast<int>(shape.factor * (c * kWidth + s * kHeight)),
          static_cast<int>(shape.factor * (s * kWidth + c * kHeight))};
  cv::Mat turn = cv::getRotationMatrix2D({kWidth / 2.0F, kHeight / 2.0F}, shape.degrees, shape.factor);
  turn.at<double>(0, 2) += size.width / 2.0 - kWidth / 2.0;
  turn.at<double>(1, 2) += size.height / 2.0 - kHeight / 2.0;
  return turn;
}

GrayImage drawn(const Shape& shape, cv::Mat& turn) {
  cv::Mat picture = draw(), out;
  cv::Size size;
  turn = transform(shape, size);
  if (shape.factor < 1) cv::GaussianBlur(picture, picture, {}, 0.4 / shape.factor);
  cv::warpAffine(picture, out, turn, size, cv::INTER_LINEAR, cv::BORDER_CONSTANT, 255);
  if (shape.thicker_px > 0)
    cv::erode(out, out,
              cv::getStructuringElement(cv::MORPH_RECT, {shape.thicker_px + 1, shape.thicker_px + 1}));
  return {out.cols, out.rows, std::vector<std::uint8_t>(out.datastart, out.dataend), 0};
}

test::WallScore score(const Shape& shape) {
  cv::Mat turn;
  const GrayImage image = drawn(shape, turn);
  std::vector<PixelSegment> truth = true_faces();
  for (PixelSegment& face : truth) {
    const std::vector<cv::Point2d> ends{{face.u1, face.v1}, {face.u2, face.v2}};
    std::vector<cv::Point2d> moved;
    cv::transform(ends, moved, turn);
    face = {moved[0].x, moved[0].y, moved[1].x, moved[1].y};
  }
  const double reach = 8 * shape.factor + shape.thicker_px;  // an inner wall is 12 thick and has two faces
  return test::score_walls(read_drawing(image, {}).walls, truth, reach);
}

TEST(OtherShapes, TheWallsOfAPlanAreFoundHoweverItIsDrawn) {
  for (const Shape& shape :
       {Shape{"as it is", 0, 1, 0}, Shape{"turned a little", 1.5, 1, 0}, Shape{"turned", 30, 1, 0},
        Shape{"two thirds", 0, 0.67, 0}, Shape{"half", 0, 0.5, 0}, Shape{"half and turned", 1.5, 0.5, 0},
        Shape{"larger", 0, 1.5, 0}, Shape{"double", 0, 2, 0}, Shape{"thicker", 0, 1, 1}}) {
    const test::WallScore got = score(shape);
    EXPECT_GT(got.recall, 0.93) << shape.name;
    EXPECT_GT(got.precision, 0.85) << shape.name;
  }
}

}  // namespace
}  // namespace madori::mapping
