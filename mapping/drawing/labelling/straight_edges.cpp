#include "mapping/drawing/labelling/straight_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"

namespace madori::mapping {
namespace {

// The constants of the paper.
constexpr double kScale = 0.8, kBlur = 0.75;      // of the picture: against the stairs of slanted lines
constexpr double kWithin = std::numbers::pi / 8;  // radians
const double kLeastStep = 2 / std::sin(kWithin);  // rounding can turn smaller ones further than that
constexpr double kDense = 0.7, kShrink = 0.75;    // share of a rectangle that its places fill
constexpr std::size_t kLevels = 1024;

/// A pixel where the grey changes.
struct Place {
  float x, y, step, cosine, sine;  // which way the edge runs there
};

struct Rectangle {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0, width = 1;
  [[nodiscard]] double density(std::size_t places) const {
    return static_cast<double>(places) / (std::hypot(x2 - x1, y2 - y1) * width);
  }
};

class Grower {
 public:
  explicit Grower(const cv::Mat& picture) : width_(picture.cols), height_(picture.rows) {
    at_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -1);
    places_.reserve(at_.size() / 8);
    for (int y = 0; y + 1 < height_; ++y)
      row(picture.ptr<std::uint8_t>(y), picture.ptr<std::uint8_t>(y + 1), y);
    used_.assign(places_.size(), false);
  }

  [[nodiscard]] std::vector<PixelSegment> segments() {
    const double tests = 2.5 * (std::log10(width_) + std::log10(height_)) + std::log10(11.0);
    const auto fewest = static_cast<std::size_t>(tests / -std::log10(kWithin / std::numbers::pi));
    std::vector<PixelSegment> found;
    for (const std::int32_t seed : strongest_first()) {
      if (used_[static_cast<std::size_t>(seed)]) continue;
      grow(seed, kWithin);
      if (region_.size() < fewest) continue;
      Rectangle r = rectangle();
      if (!refined(r)) continue;
      const auto out = [](double value) { return (value + 0.5) / kScale + 0.5; };
      found.push_back({out(r.x1), out(r.y1), out(r.x2), out(r.y2)});
    }
    return found;
  }

 private:
  void row(const std::uint8_t* here, const std::uint8_t* below, int y) {
    const int least = static_cast<int>(4 * kLeastStep * kLeastStep);
    for (int x = 0; x + 1 < width_; ++x) {
      const int falling = below[x + 1] - here[x], rising = here[x + 1] - below[x];
      const int gx = falling + rising, gy = falling - rising, square = gx * gx + gy * gy;
      if (square <= least) continue;
      const float length = std::sqrt(static_cast<float>(square));
      at_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] =
          static_cast<std::int32_t>(places_.size());
      places_.push_back({static_cast<float>(x), static_cast<float>(y), 0.5F * length,
                         -static_cast<float>(gy) / length, static_cast<float>(gx) / length});
    }
  }

  [[nodiscard]] std::vector<std::int32_t> strongest_first() const {
    float most = 1;
    for (const Place& p : places_) most = std::max(most, p.step);
    const auto level = [&](const Place& p) {
      return kLevels - 1 - static_cast<std::size_t>(p.step * (kLevels - 1) / most);
    };
    std::array<std::size_t, kLevels + 1> from{};
    for (const Place& p : places_) ++from[level(p) + 1];
    for (std::size_t k = 1; k <= kLevels; ++k) from[k] += from[k - 1];
    std::vector<std::int32_t> order(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i)
      order[from[level(places_[i])]++] = static_cast<std::int32_t>(i);
    return order;
  }

  [[nodiscard]] const Place& place(std::size_t k) const {
    return places_[static_cast<std::size_t>(region_[k])];
  }
  void mark(std::int32_t i, bool used) { used_[static_cast<std::size_t>(i)] = used; }

  /// All places that hang together with the seed and run within an angle of their mean.
  void grow(std::int32_t seed, double within) {
    const auto least = static_cast<float>(std::cos(std::min(within, std::numbers::pi)));
    region_.assign(1, seed);
    mark(seed, true);
    float cosine = place(0).cosine, sine = place(0).sine, length = 1;
    for (std::size_t k = 0; k < region_.size(); ++k) {
      const int x0 = static_cast<int>(place(k).x), y0 = static_cast<int>(place(k).y);
      for (int y = std::max(0, y0 - 1); y <= std::min(height_ - 1, y0 + 1); ++y)
        for (int x = std::max(0, x0 - 1); x <= std::min(width_ - 1, x0 + 1); ++x) {
          const std::int32_t i = at_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                     static_cast<std::size_t>(x)];
          if (i < 0 || used_[static_cast<std::size_t>(i)]) continue;
          const Place& p = places_[static_cast<std::size_t>(i)];
          if (p.cosine * cosine + p.sine * sine < least * length) continue;
          mark(i, true);
          region_.push_back(i);
          cosine += p.cosine, sine += p.sine;
          length = std::sqrt(cosine * cosine + sine * sine);
        }
    }
  }

  /// Around the region, along its principal axis.
  [[nodiscard]] Rectangle rectangle() const {
    double x = 0, y = 0, sum = 0, cosine = 0, sine = 0;
    for (std::size_t k = 0; k < region_.size(); ++k) {
      const Place& p = place(k);
      x += p.x * p.step, y += p.y * p.step, sum += p.step, cosine += p.cosine, sine += p.sine;
    }
    x /= sum, y /= sum;
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t k = 0; k < region_.size(); ++k) {
      const Place& p = place(k);
      xx += (p.x - x) * (p.x - x) * p.step, yy += (p.y - y) * (p.y - y) * p.step;
      xy += (p.x - x) * (p.y - y) * p.step;
    }
    const double axis = 0.5 * std::atan2(2 * xy, xx - yy);
    double du = std::cos(axis), dv = std::sin(axis);
    if (du * cosine + dv * sine < 0) du = -du, dv = -dv;
    double from = 0, to = 0, left = 0, right = 0;
    for (std::size_t k = 0; k < region_.size(); ++k) {
      const double along = (place(k).x - x) * du + (place(k).y - y) * dv;
      const double off = (place(k).y - y) * du - (place(k).x - x) * dv;
      from = std::min(from, along), to = std::max(to, along);
      left = std::min(left, off), right = std::max(right, off);
    }
    return {x + from * du, y + from * dv, x + to * du, y + to * dv, std::max(1.0, right - left)};
  }

  /// A region that bends is grown again more narrowly, and at last cut down around its seed.
  [[nodiscard]] bool refined(Rectangle& r) {
    if (r.density(region_.size()) >= kDense) return true;
    const Place seed = place(0);
    double sum = 0, squares = 0, count = 0;
    for (std::size_t k = 0; k < region_.size(); ++k) {
      const Place& p = place(k);
      mark(region_[k], false);
      if (std::hypot(p.x - seed.x, p.y - seed.y) >= r.width) continue;
      const double turn = std::atan2(seed.cosine * p.sine - seed.sine * p.cosine,
                                     seed.cosine * p.cosine + seed.sine * p.sine);
      sum += turn, squares += turn * turn, ++count;
    }
    const double mean = sum / count;
    grow(region_[0], 2 * std::sqrt(std::max(0.0, squares / count - mean * mean)));
    if (region_.size() < 2) return false;
    r = rectangle();
    double radius =
        std::max(std::hypot(seed.x - r.x1, seed.y - r.y1), std::hypot(seed.x - r.x2, seed.y - r.y2));
    while (r.density(region_.size()) < kDense) {
      radius *= kShrink;
      const auto cut = std::partition(region_.begin() + 1, region_.end(), [&](std::int32_t i) {
        const Place& p = places_[static_cast<std::size_t>(i)];
        return std::hypot(p.x - seed.x, p.y - seed.y) <= radius;
      });
      std::for_each(cut, region_.end(), [&](std::int32_t i) { mark(i, false); });
      region_.erase(cut, region_.end());
      if (region_.size() < 2) return false;
      r = rectangle();
    }
    return true;
  }

  int width_, height_;
  std::vector<std::int32_t> at_;  // the place of a pixel, -1 = none
  std::vector<Place> places_;
  std::vector<bool> used_;
  std::vector<std::int32_t> region_;  // its seed first
};

}  // namespace

std::vector<PixelSegment> straight_edges(const GrayImage& picture) {
  cv::Mat smooth, small;
  cv::GaussianBlur(cv_view(picture), smooth, {7, 7}, kBlur);
  cv::resize(smooth, small, {}, kScale, kScale, cv::INTER_LINEAR_EXACT);
  return Grower(small).segments();
}

}  // namespace madori::mapping
