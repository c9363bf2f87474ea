// What is measured around the edges of a drawing, beside slower ways to measure the same.
#include "mapping/drawing/labelling/edge_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/median.hpp"
#include "mapping/drawing/labelling/edge_rays.hpp"
#include "mapping/drawing/labelling/edge_regions.hpp"
#include "tests/support/paper_image.hpp"

namespace madori::mapping {
namespace {

/// Strokes of any direction and thickness, some of them filled boxes.
EdgeSheet random_sheet(unsigned seed) {
  GrayImage image = test::paper(1500, 1400);
  cv::Mat canvas = test::canvas(image);
  std::mt19937 random(seed);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  for (int k = 0; k < 60; ++k) {
    const cv::Point a(40 + below(1400), 40 + below(1300)), b(40 + below(1400), 40 + below(1300));
    if (k % 6 == 0) {
      cv::rectangle(canvas, a, a + cv::Point(20 + below(60), 20 + below(60)), below(120), cv::FILLED);
    } else {
      cv::line(canvas, a, k % 3 == 0 ? b : cv::Point(b.x, a.y), below(120), 2 + below(8), cv::LINE_AA);
    }
  }
  return find_edges(image);
}

/// Pixels from a place to the first other edge, in steps too small to miss one.
double free_px(const EdgeSheet& sheet, std::size_t from, double side, double t, double far) {
  const Edge& edge = sheet.edges[from];
  const PixelSegment& s = edge.segment;
  const double u = std::lerp(s.u1, s.u2, t), v = std::lerp(s.v1, s.v2, t);
  for (double d = 0.6; d < far; d += 0.02) {
    const double x = u + side * d * edge.normal.x, y = v + side * d * edge.normal.y;
    if (!sheet.inside(x, y)) break;
    const int met = sheet.map.edge_at(sheet.pixel(x, y));
    if (met >= 0 && met != static_cast<int>(from)) return d;
  }
  return far;
}

TEST(EdgeViews, NoEdgeIsPassedOver) {
  constexpr double kFar = 0.3, kClose = 2.5;
  std::size_t seen = 0, others = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const EdgeSheet sheet = random_sheet(seed);
    const auto views = look_across(sheet);
    for (std::size_t i = 0; i < sheet.edges.size(); ++i) {
      const int places = std::clamp(static_cast<int>(sheet.edges[i].length_px / 4), 3, 15);
      std::vector<double> free;
      for (int k = 0; k < places; ++k)
        free.push_back(free_px(sheet, i, -1, (k + 0.5) / places, kFar * sheet.size_px()));
      ++seen;
      if (std::abs(views[i].bright.free_px - median_of(free)) > kClose) ++others;
    }
  }
  EXPECT_GT(seen, 1000U);
  EXPECT_LT(50 * others, seen) << "more than a corner of an edge's last pixel now and then";
}

TEST(EdgeViews, MeasureAStrokeToAPixel) {
  for (const double width : {4.3, 6.8, 9.5}) {
    GrayImage image = test::paper(1500, 1400);
    for (int v = 600; v < 640; ++v)  // grey where the stroke covers a pixel in part
      for (int u = 200; u < 1300; ++u) {
        const double covered =
            std::clamp(std::min(v + 1.0, 620.4 + width) - std::max(1.0 * v, 620.4), 0.0, 1.0);
        image.pixels[static_cast<std::size_t>(v) * 1500 + static_cast<std::size_t>(u)] =
            static_cast<std::uint8_t>(std::lround(255 * (1 - covered)));
      }
    const EdgeSheet sheet = find_edges(image);
    ASSERT_EQ(sheet.factor, 1);
    const auto longest = std::max_element(sheet.edges.begin(), sheet.edges.end(),
                                          [](auto& a, auto& b) { return a.length_px < b.length_px; });
    const auto views = look_across(sheet);
    EXPECT_NEAR(views[static_cast<std::size_t>(longest - sheet.edges.begin())].dark.hits[0].distance_px,
                width, 0.35);
  }
}

/// The same by OpenCV's connected components.
Region region_beside(const EdgeSheet& sheet, const cv::Mat& labels, const cv::Mat& stats, const Edge& edge,
                     double side) {
  std::map<int, int> votes;
  const int places = std::clamp(static_cast<int>(edge.length_px / 6), 3, 9);
  for (int k = 0; k < places; ++k) {
    const double t = (k + 0.5) / places;
    const double u = std::lerp(edge.segment.u1, edge.segment.u2, t) + side * 3 * edge.normal.x;
    const double v = std::lerp(edge.segment.v1, edge.segment.v2, t) + side * 3 * edge.normal.y;
    if (!sheet.inside(u, v)) continue;
    const int label = labels.at<int>(static_cast<int>(v), static_cast<int>(u));
    if (label > 0) ++votes[label];
  }
  if (votes.empty()) return {};
  const int most = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first;
  return {1.0 * stats.at<int>(most, cv::CC_STAT_AREA),
          cv::Size(stats.at<int>(most, cv::CC_STAT_WIDTH), stats.at<int>(most, cv::CC_STAT_HEIGHT)),
          cv::mean(cv::Mat(labels.size(), CV_8UC1, const_cast<std::uint8_t*>(sheet.grey.pixels.data())),
                   labels == most)[0]};
}

cv::Mat clear_of(const EdgeSheet& sheet) {
  cv::Mat clear(sheet.grey.height_px, sheet.grey.width_px, CV_32FC1);
  std::size_t pixel = 0;
  for (float& value : cv::Mat_<float>(clear)) value = sheet.map.clear_px(pixel++);
  return clear;
}

TEST(EdgeMap, MeasuresAsOpenCvOnAnyNumberOfThreads) {
  const EdgeSheet sheet = random_sheet(3);
  const cv::Size size(sheet.grey.width_px, sheet.grey.height_px);
  cv::Mat free(size, CV_8UC1), expected;
  std::size_t pixel = 0;
  for (std::uint8_t& value : cv::Mat_<std::uint8_t>(free)) value = sheet.map.edge_at(pixel++) < 0 ? 255 : 0;
  cv::distanceTransform(free, expected, cv::DIST_L2, 3);
  const int threads = cv::getNumThreads();
  for (const int of : {1, 2, 5}) {
    cv::setNumThreads(of);
    EdgeMap map(size.width, size.height);
    for (std::size_t i = 0; i < sheet.edges.size(); ++i)
      map.draw(sheet.edges[i].segment, static_cast<int>(i));
    map.measure_distances();
    for (pixel = 0; pixel < map.size(); ++pixel)
      ASSERT_EQ(map.clear_px(pixel), expected.at<float>(static_cast<int>(pixel))) << of << " at " << pixel;
  }
  cv::setNumThreads(threads);
}

TEST(EdgeMap, MeasuresAsOpenCvInRowsOfAnyLength) {
  for (int width = 1; width <= 35; ++width) {
    const int height = 1 + width % 7;
    EdgeMap map(width, height);
    const double u = width * 5 % 11 % width + 0.5, v = width % 3 % height + 0.5;
    map.draw({u, v, u, v}, 0);
    map.measure_distances();
    cv::Mat free(height, width, CV_8UC1, cv::Scalar(255)), expected;
    free.at<std::uint8_t>(static_cast<int>(v), static_cast<int>(u)) = 0;
    cv::distanceTransform(free, expected, cv::DIST_L2, 3);
    for (int pixel = 0; pixel < width * height; ++pixel)
      ASSERT_EQ(map.clear_px(static_cast<std::size_t>(pixel)),
                expected.at<float>(pixel / width, pixel % width))
          << width << " at " << pixel;
  }
}

TEST(EdgeRegions, AreTheConnectedComponentsBetweenEdges) {
  const EdgeSheet sheet = random_sheet(4);
  const cv::Mat clear = clear_of(sheet);
  cv::Mat labels, stats, middles;
  cv::connectedComponentsWithStats(clear > 1.2, labels, stats, middles, 4, CV_32S);
  const auto regions = regions_beside(sheet);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Region expected = region_beside(sheet, labels, stats, sheet.edges[i], 1);
    ASSERT_EQ(regions[i].dark.area_px, expected.area_px) << i;
    ASSERT_EQ(regions[i].dark.box_px, expected.box_px) << i;
    ASSERT_NEAR(regions[i].dark.grey, expected.grey, 1e-6) << i;
  }
}

}  // namespace
}  // namespace madori::mapping
