#include "mapping/drawing/labelling/straight_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <numeric>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>
#include <span>

#include "mapping/picture/cv_view.hpp"

namespace madori::mapping {
namespace {

// The constants of the paper.
constexpr double kScale = 0.8, kBlur = 0.75;      // of the picture: against the stairs of slanted lines
constexpr double kWithin = std::numbers::pi / 8;  // radians
const double kLeastStep = 2 / std::sin(kWithin);  // rounding can turn smaller ones further than that
constexpr double kDense = 0.7, kShrink = 0.75;    // share of a rectangle that its places fill
constexpr std::size_t kLevels = 1024;

/// A pixel where the grey changes, and the pixels around it where it does: row by row, those of a row one
/// behind the other.
struct Place {
  float x, y, step, cosine, sine;  // which way the edge runs there
  std::int32_t above, below;       // its first neighbours there
  std::int8_t count_above, count_below, left, right;
};

/// Calls visit(x, gx, gy) for every pixel of a row where the grey changes, with twice the gradient there.
template <class Visit>
void for_changes(const cv::Mat& picture, int y, const Visit& visit) {
  constexpr int kAtOnce = cv::v_uint8x16::nlanes;
  const auto *here = picture.ptr<std::uint8_t>(y), *below = picture.ptr<std::uint8_t>(y + 1);
  const auto still = cv::v_setall_u8(static_cast<std::uint8_t>(kLeastStep));
  const int least = static_cast<int>(4 * kLeastStep * kLeastStep), end = picture.cols - 1;
  for (int from = 0; from < end; from += kAtOnce) {
    if (from + kAtOnce <= end) {  // paper: neither diagonal changes anywhere
      const auto falling = cv::v_absdiff(cv::v_load(below + from + 1), cv::v_load(here + from));
      const auto rising = cv::v_absdiff(cv::v_load(here + from + 1), cv::v_load(below + from));
      if (!cv::v_check_any(cv::v_max(falling, rising) > still)) continue;
    }
    for (int x = from; x < std::min(from + kAtOnce, end); ++x) {
      const int falling = below[x + 1] - here[x], rising = here[x + 1] - below[x];
      const int gx = falling + rising, gy = falling - rising;
      if (gx * gx + gy * gy > least) visit(x, gx, gy);
    }
  }
}

struct Rectangle {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0, width = 1;
  [[nodiscard]] double density(std::size_t places) const {
    return static_cast<double>(places) / (std::hypot(x2 - x1, y2 - y1) * width);
  }
};

class Grower {
 public:
  explicit Grower(const cv::Mat& picture) : width_(picture.cols), height_(picture.rows) {
    const int rows = std::max(0, height_ - 1);
    rows_.assign(static_cast<std::size_t>(rows) + 1, 0);
    for_rows(rows, [&](std::size_t y) {
      for_changes(picture, static_cast<int>(y), [&](int, int, int) { ++rows_[y + 1]; });
    });
    std::partial_sum(rows_.begin(), rows_.end(), rows_.begin());
    count_ = static_cast<std::size_t>(rows_.back());
    places_ = std::make_unique_for_overwrite<Place[]>(count_);
    for_rows(rows, [&](std::size_t y) { find_places(picture, y); });
    for_rows(rows, [&](std::size_t y) {
      link(y, y > 0 ? y - 1 : y, &Place::above, &Place::count_above);
      link(y, y + 2 < rows_.size() ? y + 1 : y, &Place::below, &Place::count_below);
    });
    used_.assign(count_, 0);
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
  template <class Work>
  static void for_rows(int rows, const Work& work) {
    cv::parallel_for_({0, rows}, [&](const cv::Range& some) {
      for (int y = some.start; y < some.end; ++y) work(static_cast<std::size_t>(y));
    });
  }

  void find_places(const cv::Mat& picture, std::size_t y) {
    Place* const first = &places_[static_cast<std::size_t>(rows_[y])];
    Place* next = first;
    for_changes(picture, static_cast<int>(y), [&](int x, int gx, int gy) {
      const float length = std::sqrt(static_cast<float>(gx * gx + gy * gy));
      const bool beside = next > first && static_cast<int>(next[-1].x) == x - 1;
      if (beside) next[-1].right = 1;
      *next++ = {static_cast<float>(x),
                 static_cast<float>(y),
                 0.5F * length,
                 -static_cast<float>(gy) / length,
                 static_cast<float>(gx) / length,
                 0,
                 0,
                 0,
                 0,
                 static_cast<std::int8_t>(beside),
                 0};
    });
  }

  /// Gives the places of a row their neighbours in another one; none in their own.
  void link(std::size_t row, std::size_t other, std::int32_t Place::*neighbours, std::int8_t Place::*count) {
    std::int32_t first = rows_[other];
    const std::int32_t last = other == row ? first : rows_[other + 1];
    for (auto i = static_cast<std::size_t>(rows_[row]); i < static_cast<std::size_t>(rows_[row + 1]); ++i) {
      Place& p = places_[i];
      const auto x_of = [&](std::int32_t j) { return places_[static_cast<std::size_t>(j)].x; };
      while (first < last && x_of(first) < p.x - 1) ++first;
      std::int32_t end = first;
      while (end < last && x_of(end) <= p.x + 1) ++end;
      p.*neighbours = first;
      p.*count = static_cast<std::int8_t>(end - first);
    }
  }

  [[nodiscard]] std::vector<std::int32_t> strongest_first() const {
    const std::span<const Place> places(places_.get(), count_);
    float most = 1;
    for (const Place& p : places) most = std::max(most, p.step);
    const auto level = [&](const Place& p) {
      return kLevels - 1 - static_cast<std::size_t>(p.step * (kLevels - 1) / most);
    };
    std::array<std::size_t, kLevels + 1> from{};
    for (const Place& p : places) ++from[level(p) + 1];
    for (std::size_t k = 1; k <= kLevels; ++k) from[k] += from[k - 1];
    std::vector<std::int32_t> order(count_);
    for (std::size_t i = 0; i < count_; ++i) order[from[level(places[i])]++] = static_cast<std::int32_t>(i);
    return order;
  }

  [[nodiscard]] const Place& place(std::size_t k) const {
    return places_[static_cast<std::size_t>(region_[k])];
  }
  void mark(std::int32_t i, bool used) { used_[static_cast<std::size_t>(i)] = used ? 1 : 0; }

  /// All places that hang together with the seed and run within an angle of their mean.
  void grow(std::int32_t seed, double within) {
    const auto least = static_cast<float>(std::cos(std::min(within, std::numbers::pi)));
    region_.assign(1, seed);
    mark(seed, true);
    float cosine = place(0).cosine, sine = place(0).sine, length = 1;
    for (std::size_t k = 0; k < region_.size(); ++k) {
      const std::int32_t own = region_[k];
      const Place& p = place(k);
      const std::array<std::array<std::int32_t, 2>, 3> rows{{{p.above, p.above + p.count_above},
                                                             {own - p.left, own + 1 + p.right},
                                                             {p.below, p.below + p.count_below}}};
      for (const auto& [first, end] : rows)
        for (std::int32_t i = first; i < end; ++i) {
          if (used_[static_cast<std::size_t>(i)] != 0) continue;
          const Place& next = places_[static_cast<std::size_t>(i)];
          if (next.cosine * cosine + next.sine * sine < least * length) continue;
          mark(i, true);
          region_.push_back(i);
          __builtin_prefetch(&places_[static_cast<std::size_t>(next.above)]);
          __builtin_prefetch(&places_[static_cast<std::size_t>(next.below)]);
          cosine += next.cosine, sine += next.sine;
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
  std::vector<std::int32_t> rows_;  // the first place of each, and the end of all
  std::unique_ptr<Place[]> places_;
  std::size_t count_ = 0;
  std::vector<std::uint8_t> used_;    // a place each
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
