#include "mapping/drawing/raster/hough_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"

namespace madori::mapping {
namespace {

constexpr int kTile = 512;
constexpr double kLargestGap = 2;

}  // namespace

std::vector<PixelSegment> hough_seeds(const GrayImage& lines, double shortest_px) {
  const cv::Mat picture = cv_view(lines);
  const int votes = std::max(8, static_cast<int>(0.7 * shortest_px));
  std::vector<PixelSegment> seeds;
  std::vector<cv::Vec4i> found;
  for (int v = 0; v < lines.height_px; v += kTile) {
    for (int u = 0; u < lines.width_px; u += kTile) {
      const cv::Rect tile(u, v, std::min(kTile, lines.width_px - u), std::min(kTile, lines.height_px - v));
      const cv::Mat part = picture(tile);
      if (cv::countNonZero(part) < votes) continue;
      cv::HoughLinesP(part, found, 1, CV_PI / 180, votes, shortest_px, kLargestGap);
      for (const auto& line : found)
        seeds.push_back({line[0] + u + 0.5, line[1] + v + 0.5, line[2] + u + 0.5, line[3] + v + 0.5});
    }
  }
  std::stable_sort(seeds.begin(), seeds.end(), [](const PixelSegment& a, const PixelSegment& b) {
    return a.length_px() > b.length_px();
  });
  return seeds;
}

}  // namespace madori::mapping
