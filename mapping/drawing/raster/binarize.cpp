#include "mapping/drawing/raster/binarize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"
#include "mapping/drawing/raster/paper.hpp"
#include "mapping/drawing/raster/skip_paper.hpp"

namespace madori::mapping {
namespace {

constexpr int kReach = 2;          // pixels between the two sides of an edge: spans the blur of a scan
constexpr int kEnlargedReach = 3;  // ... and of enlarging
constexpr int kRowStep = 5;        // every fifth row is sample enough
constexpr int kNoiseStep = 16;     // ... and far fewer for the noise
constexpr int kSharedRows = 4;
constexpr double kLeastContrast = 16;
constexpr float kEdge = 0.55F;      // of the way from a stroke's darkest to the paper
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

/// Ink by a threshold on a paper of 255.
void compare(const GrayImage& image, const Paper& paper, double threshold, GrayImage& ink) {
  if (!paper.is_even()) return compare_with_paper(image, paper, threshold / 255, ink);
  cv::Mat out = cv_view(ink);
  cv::threshold(cv_view(image), out, std::floor(threshold * paper.level() / 255), 255, cv::THRESH_BINARY_INV);
}

/// Whether a pixel darker than this lies within reach.
bool darker_near(const GrayImage& image, int u, int v, int than, int reach) {
  for (int y = std::max(0, v - reach); y <= std::min(image.height_px - 1, v + reach); ++y)
    for (int x = std::max(0, u - reach); x <= std::min(image.width_px - 1, u + reach); ++x)
      if (image.at(x, y) < than) return true;
  return false;
}

/// Takes from the ink what is nearer to the paper than to the darkest pixel around: half way lies the edge of
/// a stroke, whatever its grey, and however blurred.
void trim_edges(const GrayImage& image, const Paper& paper, int reach, GrayImage& ink) {
  const auto width = static_cast<std::size_t>(image.width_px);
  std::vector<float> levels(width, static_cast<float>(paper.level()));
  for (int v = 0; v < image.height_px; ++v) {
    if (!paper.is_even() && v % kSharedRows == 0) paper.row(v + kSharedRows / 2, levels);
    std::uint8_t* row = &ink.pixels[static_cast<std::size_t>(v) * width];
    for (std::size_t u = skip_paper(row, 0, width); u < width; u = skip_paper(row, u + 1, width)) {
      const auto column = static_cast<int>(u);
      const float edge = (image.at(column, v) - kEdge * levels[u]) / (1 - kEdge);
      if (edge > 0 && darker_near(image, column, v, static_cast<int>(std::ceil(edge)), reach)) row[u] = 0;
    }
  }
}

}  // namespace

Binarized binarize(const GrayImage& image, std::optional<double> threshold) {
  const Paper paper(image);
  Binarized result{blank_like(image), threshold ? *threshold : best_threshold(image, paper)};
  const bool absolute = threshold && paper.is_even();
  compare(image, paper, absolute ? *threshold * 255 / paper.level() : result.threshold, result.ink);
  if (!threshold) trim_edges(image, paper, kReach, result.ink);
  return result;
}

Binarized binarize_enlarged(const GrayImage& image, double threshold) {
  const Paper paper(image);
  Binarized result{blank_like(image), threshold};
  compare(image, paper, threshold, result.ink);
  trim_edges(image, paper, kEnlargedReach, result.ink);
  return result;
}

}  // namespace madori::mapping
