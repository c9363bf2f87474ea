#include "mapping/drawing/raster/paper.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace madori::mapping {
namespace {

constexpr int kBlock = 32;
constexpr int kSampleStep = 4;
constexpr double kPaperShare = 0.90;    // the bright end of a block: robust against a few glints
constexpr double kDarkestPaper = 0.55;  // of the common level; darker areas are fills, not shadows
constexpr double kEvenWithin = 10;      // grey levels

float bright_end(const GrayImage& image, int u0, int v0) {
  std::uint8_t samples[(kBlock / kSampleStep) * (kBlock / kSampleStep)];
  std::size_t n = 0;
  for (int v = v0; v < std::min(v0 + kBlock, image.height_px); v += kSampleStep)
    for (int u = u0; u < std::min(u0 + kBlock, image.width_px); u += kSampleStep)
      samples[n++] = image.at(u, v);
  const auto rank = static_cast<std::ptrdiff_t>(kPaperShare * static_cast<double>(n - 1));
  std::nth_element(samples, samples + rank, samples + n);
  return samples[rank];
}

}  // namespace

void Paper::fill_from(const GrayImage& image) {
  columns_ = (image.width_px + kBlock - 1) / kBlock;
  rows_ = (image.height_px + kBlock - 1) / kBlock;
  blocks_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      blocks_.push_back(bright_end(image, column * kBlock, row * kBlock));
}

Paper::Paper(const GrayImage& image) {
  fill_from(image);
  std::vector<float> sorted = blocks_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 3 / 4);
  std::nth_element(sorted.begin(), middle, sorted.end());
  level_ = std::max(1.0F, *middle);
  cv::Mat grid(rows_, columns_, CV_32FC1, blocks_.data());
  const auto box = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::morphologyEx(grid, grid, cv::MORPH_CLOSE, box);
  for (float& block : blocks_) block = std::max(block, static_cast<float>(kDarkestPaper * level_));
  cv::blur(grid, grid, {3, 3});
  const auto [low, high] = std::minmax_element(blocks_.begin(), blocks_.end());
  even_ = *high - *low < kEvenWithin;
}

double Paper::at(int u, int v) const {
  const double x = std::clamp((u + 0.5) / kBlock - 0.5, 0.0, columns_ - 1.0);
  const double y = std::clamp((v + 0.5) / kBlock - 0.5, 0.0, rows_ - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, columns_ - 1), y1 = std::min(y0 + 1, rows_ - 1);
  const auto block = [&](int column, int row) {
    return static_cast<double>(blocks_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                       static_cast<std::size_t>(column)]);
  };
  const double above = std::lerp(block(x0, y0), block(x1, y0), x - x0);
  const double below = std::lerp(block(x0, y1), block(x1, y1), x - x0);
  return std::lerp(above, below, y - y0);
}

void Paper::row(int v, std::vector<float>& out) const {
  const double y = std::clamp((v + 0.5) / kBlock - 0.5, 0.0, rows_ - 1.0);
  const int y0 = static_cast<int>(y), y1 = std::min(y0 + 1, rows_ - 1);
  const auto part = static_cast<float>(y - y0);
  const float* above = &blocks_[static_cast<std::size_t>(y0) * static_cast<std::size_t>(columns_)];
  const float* below = &blocks_[static_cast<std::size_t>(y1) * static_cast<std::size_t>(columns_)];
  const int width = static_cast<int>(out.size());
  for (int column = -1; column < columns_; ++column) {  // between the middles of two blocks
    const int left = std::max(column, 0), right = std::min(column + 1, columns_ - 1);
    const float a = std::lerp(above[left], below[left], part),
                b = std::lerp(above[right], below[right], part);
    const int first = column * kBlock + kBlock / 2;
    const float step = (b - a) / kBlock;
    for (int u = std::max(first, 0); u < std::min(first + kBlock, width); ++u)
      out[static_cast<std::size_t>(u)] = a + step * (static_cast<float>(u - first) + 0.5F);
  }
}

}  // namespace madori::mapping
