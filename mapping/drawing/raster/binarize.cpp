#include "mapping/drawing/raster/binarize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"
#include "mapping/drawing/raster/paper.hpp"

namespace madori::mapping {
namespace {

constexpr int kReach = 2;       // pixels between the two sides of an edge: spans the blur of a scan
constexpr int kRowStep = 5;     // every fifth row is sample enough
constexpr int kNoiseStep = 16;  // ... and far fewer for the noise
constexpr int kSharedRows = 4;
constexpr double kLeastContrast = 16;
constexpr double kNearBest = 0.96;  // thresholds that cross almost as many edges form the plateau
using Levels = std::array<double, 257>;

/// Calls visit(brighter, darker, u, v) for sampled pixel pairs across and down.
template <class Visit>
void for_pairs(const GrayImage& image, int row_step, Visit visit) {
  const auto width = static_cast<std::size_t>(image.width_px);
  for (int v = 0; v + kReach < image.height_px; v += row_step) {
    const std::uint8_t* row = &image.pixels[static_cast<std::size_t>(v) * width];
    const std::uint8_t* below = row + kReach * width;
    for (int u = 0; u + kReach < image.width_px; ++u) {
      visit(row[u], row[u + kReach], u, v);
      visit(row[u], below[u], u, v);
    }
  }
}

/// The difference of neighbours on empty paper.
double noise_of(const GrayImage& image) {
  std::array<std::size_t, 256> counts{};
  std::size_t total = 0;
  for_pairs(image, kNoiseStep, [&](int a, int b, int, int) {
    ++counts[static_cast<std::size_t>(std::abs(a - b))];
    ++total;
  });
  std::size_t seen = 0, difference = 0;
  while (difference < 255 && (seen += counts[difference]) < total * 3 / 4) ++difference;
  return static_cast<double>(difference);
}

/// How many edges each threshold crosses, on a paper of 255.
Levels crossings(const GrayImage& image, const Paper& paper, double least_contrast) {
  Levels steps{};
  const int least = static_cast<int>(std::ceil(least_contrast));
  for_pairs(image, kRowStep, [&](int a, int b, int u, int v) {
    if (std::abs(a - b) < least) return;
    const double gain = 255.0 / paper.at(u, v);
    const auto level = [gain](int value) {
      return static_cast<std::size_t>(std::clamp(std::lround(value * gain), 0L, 255L));
    };
    steps[level(std::min(a, b)) + 1] += std::abs(a - b);
    steps[level(std::max(a, b)) + 1] -= std::abs(a - b);
  });
  double sum = 0;
  for (double& step : steps) step = sum += step;
  return steps;
}

double best_threshold(const GrayImage& image, const Paper& paper) {
  const double noise = noise_of(image);
  const Levels count = crossings(image, paper, std::max(kLeastContrast, 4 * noise));
  const double most = *std::max_element(count.begin(), count.end());
  if (most <= 0) return 128;
  const auto enough = [&](double value) { return value >= kNearBest * most; };
  const auto low = std::find_if(count.begin(), count.end(), enough) - count.begin();
  const auto high = count.rend() - std::find_if(count.rbegin(), count.rend(), enough) - 1;
  return std::min(0.5 * static_cast<double>(low + high), 250 - 2 * noise);
}

/// Dark for the paper around it. The paper is smooth: a few rows share one row of thresholds.
void compare_with_paper(const GrayImage& image, const Paper& paper, double share, GrayImage& ink) {
  const cv::Mat grey = cv_view(image);
  cv::Mat out = cv_view(ink), thresholds;
  std::vector<float> levels(static_cast<std::size_t>(image.width_px));
  for (int v = 0; v < image.height_px; ++v) {
    if (v % kSharedRows == 0) {
      paper.row(v + kSharedRows / 2, levels);
      cv::Mat(1, image.width_px, CV_32FC1, levels.data()).convertTo(thresholds, CV_8U, share);
    }
    cv::Mat row = out.row(v);
    cv::compare(grey.row(v), thresholds, row, cv::CMP_LE);
  }
}

}  // namespace

Binarized binarize(const GrayImage& image, std::optional<double> threshold) {
  const Paper paper(image);
  Binarized result{blank_like(image), threshold ? *threshold : best_threshold(image, paper)};
  cv::Mat ink = cv_view(result.ink);
  if (paper.is_even()) {
    const double level = threshold ? *threshold : result.threshold * paper.level() / 255;
    cv::threshold(cv_view(image), ink, std::floor(level), 255, cv::THRESH_BINARY_INV);
    return result;
  }
  compare_with_paper(image, paper, result.threshold / 255, result.ink);
  return result;
}

}  // namespace madori::mapping
