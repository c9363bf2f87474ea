// The edges of a drawing are those of OpenCV's line segment detector.
#include "mapping/drawing/labelling/straight_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "mapping/picture/cv_view.hpp"
#include "mapping/picture/load_image.hpp"

namespace madori::mapping {
namespace {

bool same(const PixelSegment& a, const cv::Vec4f& b) {
  const auto near = [](double x, float y) { return std::abs(x - 0.5 - y) < 0.5; };
  return near(a.u1, b[0]) && near(a.v1, b[1]) && near(a.u2, b[2]) && near(a.v2, b[3]);
}

TEST(StraightEdges, AreThoseOfOpenCv) {
  const GrayImage image =
      load_image(std::string(MADORI_SOURCE_DIR) + "/data/sample_factory/factory_scan.png");
  const auto own = straight_edges(image);
  std::vector<cv::Vec4f> theirs;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD)->detect(cv_view(image), theirs);
  double all = 0, found = 0, length = 0;
  for (const cv::Vec4f& s : theirs) {
    const double long_px = std::hypot(s[2] - s[0], s[3] - s[1]);
    all += long_px;
    if (std::any_of(own.begin(), own.end(), [&](const PixelSegment& e) { return same(e, s); }))
      found += long_px;
  }
  for (const PixelSegment& e : own) length += e.length_px();
  EXPECT_GT(found, 0.95 * all);  // where steps are equally strong the order of the seeds is open
  EXPECT_NEAR(length, all, 0.01 * all);
}

TEST(StraightEdges, HaveTheDarkSideOnTheSameHand) {
  GrayImage image{200, 100, std::vector<std::uint8_t>(20000, 255), 0};
  cv::rectangle(cv::Mat(100, 200, CV_8UC1, image.pixels.data()), {40, 30}, {159, 69}, cv::Scalar(0),
                cv::FILLED);
  const auto edges = straight_edges(image);
  ASSERT_EQ(edges.size(), 4U);
  double area = 0;  // by the shoelace formula: all four go round the same way
  for (const PixelSegment& e : edges) area += 0.5 * ((e.u1 - 100) * (e.v2 - 50) - (e.u2 - 100) * (e.v1 - 50));
  EXPECT_NEAR(std::abs(area), 120 * 40, 300);
}

TEST(StraightEdges, OfPaperAreNone) {
  EXPECT_TRUE(straight_edges({50, 40, std::vector<std::uint8_t>(2000, 240), 0}).empty());
  EXPECT_TRUE(straight_edges({1, 1, {0}, 0}).empty());
}

}  // namespace
}  // namespace madori::mapping
