#include "mapping/drawing/labelling/edge_map.hpp"

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace madori::mapping {
namespace {

// As OpenCV's distanceTransform has them, so that both measure alike to the last bit.
constexpr double kAcrossPx = 0.955F, kAslantPx = 1.3693F;
constexpr std::int32_t kFarthest = std::numeric_limits<std::int32_t>::max() / 4;
constexpr int kLeastRows = 256;  // of a band: its seams are walked twice

/// By value: std::max of an element is a reference, which keeps a loop from being done several pixels at
/// once.
constexpr std::int32_t nearer(std::int32_t a, std::int32_t b) {
  return a > b ? a : b;
}

/// Carries what rows know of the next edge from one to the next, down or up.
class Sweep {
 public:
  enum class From { Left, Right };

  /// `row` knows something; nullptr: nothing is known before the first row.
  Sweep(const std::int32_t* row, int width, From side)
      : side_(side), known_(static_cast<std::size_t>(width) + 2, -kFarthest), next_(known_) {
    for (int u = 0; row != nullptr && u < width; ++u)
      known_[static_cast<std::size_t>(u) + 1] = std::min(row[u], 0);
  }

  /// The next row comes to know what the one before and its own pixels to one side know; whether it learned
  /// anything.
  bool take(std::int32_t* row) {
    constexpr auto kAcross = static_cast<std::int32_t>(kAcrossPx * EdgeMap::kUnit + 0.5),
                   kAslant = static_cast<std::int32_t>(kAslantPx * EdgeMap::kUnit + 0.5);
    const int width = static_cast<int>(known_.size()) - 2;
    const std::int32_t* const before = known_.data() + 1;
    std::int32_t* const here = next_.data() + 1;
#pragma omp simd
    for (int u = 0; u < width; ++u) {
      const std::int32_t own = row[u] < 0 ? row[u] : 0;
      const std::int32_t aslant = nearer(before[u - 1], before[u + 1]) - kAslant;
      here[u] = nearer(own, nearer(before[u] - kAcross, aslant));
    }
    std::int32_t beside = -kFarthest;
    if (side_ == From::Left)
      for (int u = 0; u < width; ++u) here[u] = beside = nearer(here[u], beside - kAcross);
    else
      for (int u = width - 1; u >= 0; --u) here[u] = beside = nearer(here[u], beside - kAcross);
    int learned = 0;
#pragma omp simd reduction(| : learned)
    for (int u = 0; u < width; ++u) {
      learned |= row[u] < here[u] ? 1 : 0;
      row[u] = nearer(row[u], here[u]);
    }
    std::swap(known_, next_);
    return learned != 0;
  }

 private:
  From side_;
  std::vector<std::int32_t> known_, next_;  // of a row, with a pixel beyond both of its ends
};

}  // namespace

EdgeMap::EdgeMap(int width_px, int height_px)
    : width_(width_px),
      height_(height_px),
      pixels_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), -kFarthest) {}

void EdgeMap::draw(const PixelSegment& edge, int number) {
  cv::Mat picture(height_, width_, CV_32SC1, pixels_.data());
  const auto at = [](double u, double v) {
    return cv::Point(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
  };
  cv::line(picture, at(edge.u1, edge.v1), at(edge.u2, edge.v2), cv::Scalar(number));
}

void EdgeMap::measure_distances() {
  const int bands = std::clamp(cv::getNumThreads(), 1, std::max(1, height_ / kLeastRows));
  const auto top = [&](int band) { return static_cast<int>(std::int64_t{height_} * band / bands); };
  cv::parallel_for_({0, bands}, [&](const cv::Range& some) {
    for (int band = some.start; band < some.end; ++band) {
      Sweep down(nullptr, width_, Sweep::From::Left), up(nullptr, width_, Sweep::From::Right);
      for (int v = top(band); v < top(band + 1); ++v) down.take(row(v));
      for (int v = top(band + 1) - 1; v >= top(band); --v) up.take(row(v));
    }
  });
  // What a band knows goes on into the next one as far as it is nearer than what that one knows itself.
  for (int band = 1; band < bands; ++band) {
    Sweep down(row(top(band) - 1), width_, Sweep::From::Left);
    for (int v = top(band); v < height_ && down.take(row(v)); ++v) continue;
  }
  for (int band = bands - 1; band > 0; --band) {
    Sweep up(row(top(band)), width_, Sweep::From::Right);
    for (int v = top(band) - 1; v >= 0 && up.take(row(v)); --v) continue;
  }
}

}  // namespace madori::mapping
