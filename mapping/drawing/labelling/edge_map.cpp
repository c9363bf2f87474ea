#include "mapping/drawing/labelling/edge_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace madori::mapping {
namespace {

// As OpenCV's distanceTransform has them, so that both measure alike to the last bit.
constexpr double kAcrossPx = 0.955F, kAslantPx = 1.3693F;
constexpr std::int32_t kFarthest = std::numeric_limits<std::int32_t>::max() / 4;
constexpr int kLeastRows = 256;  // of a band: its seams are walked twice

constexpr auto kAcross = static_cast<std::int32_t>(kAcrossPx * EdgeMap::kUnit + 0.5),
               kAslant = static_cast<std::int32_t>(kAslantPx * EdgeMap::kUnit + 0.5);
constexpr std::size_t kLanes = 8;
using Lanes [[gnu::vector_size(4 * kLanes)]] = std::int32_t;  // neighbours of a row
constexpr Lanes kNone = Lanes{} - kFarthest, kRising = kAcross * Lanes{1, 2, 3, 4, 5, 6, 7, 8},
                kFalling = kAcross * Lanes{8, 7, 6, 5, 4, 3, 2, 1};

enum class From { Left, Right };

[[gnu::always_inline]] inline Lanes load(const std::int32_t* at, std::size_t count = kLanes) {
  Lanes lanes = kNone;
  std::memcpy(&lanes, at, count * sizeof(*at));
  return lanes;
}
[[gnu::always_inline]] inline void store(const Lanes& lanes, std::int32_t* at, std::size_t count) {
  std::memcpy(at, &lanes, count * sizeof(*at));
}
[[gnu::always_inline]] inline Lanes nearer(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}

/// What each lane knows by itself, by those to one side, and by what lies `beside` them all there.
template <From kSide>
[[gnu::always_inline]] inline Lanes along(Lanes own, std::int32_t beside) {
  if constexpr (kSide == From::Left) {
    own = nearer(own, __builtin_shufflevector(kNone, own, 7, 8, 9, 10, 11, 12, 13, 14) - kAcross);
    own = nearer(own, __builtin_shufflevector(kNone, own, 6, 7, 8, 9, 10, 11, 12, 13) - 2 * kAcross);
    own = nearer(own, __builtin_shufflevector(kNone, own, 4, 5, 6, 7, 8, 9, 10, 11) - 4 * kAcross);
    return nearer(own, beside - kRising);
  } else {
    own = nearer(own, __builtin_shufflevector(own, kNone, 1, 2, 3, 4, 5, 6, 7, 8) - kAcross);
    own = nearer(own, __builtin_shufflevector(own, kNone, 2, 3, 4, 5, 6, 7, 8, 9) - 2 * kAcross);
    own = nearer(own, __builtin_shufflevector(own, kNone, 4, 5, 6, 7, 8, 9, 10, 11) - 4 * kAcross);
    return nearer(own, beside - kFalling);
  }
}

/// `row` comes to know what the one `before` it knows and its own pixels to one side; whether it learned
/// anything. All that it knows goes to `here`.
template <From kSide>
[[gnu::always_inline]] inline bool carry(const std::int32_t* before, std::int32_t* here, std::int32_t* row,
                                         std::size_t width) {
  Lanes learned{};
  std::int32_t beside = -kFarthest;
  const auto take = [&](std::size_t u, std::size_t count) __attribute__((always_inline)) {
    const Lanes pixels = load(row + u, count);
    const Lanes aslant = nearer(load(before + u - 1), load(before + u + 1)) - kAslant;
    const Lanes above = nearer(load(before + u) - kAcross, aslant);
    const Lanes knows = along<kSide>(nearer(pixels < 0 ? pixels : Lanes{}, above), beside);
    beside = knows[kSide == From::Left ? kLanes - 1 : 0];
    store(knows, here + u, count);
    store(nearer(pixels, knows), row + u, count);
    learned |= pixels < load(here + u, count);
  };
  const std::size_t whole = width / kLanes * kLanes;
  if (kSide == From::Right && whole < width) take(whole, width - whole);
  for (std::size_t done = 0; done < whole; done += kLanes)
    take(kSide == From::Left ? done : whole - kLanes - done, kLanes);
  if (kSide == From::Left && whole < width) take(whole, width - whole);
  std::int32_t any = 0;
  for (std::size_t k = 0; k < kLanes; ++k) any |= learned[k];
  return any != 0;
}

using Carry = bool (*)(const std::int32_t*, std::int32_t*, std::int32_t*, std::size_t);

template <From kSide>
bool carry_anywhere(const std::int32_t* before, std::int32_t* here, std::int32_t* row, std::size_t width) {
  return carry<kSide>(before, here, row, width);
}
#ifdef __x86_64__
/// Twice as fast: all lanes at once, and their maximum in one instruction.
template <From kSide>
[[gnu::target("avx2")]] bool carry_avx2(const std::int32_t* before, std::int32_t* here, std::int32_t* row,
                                        std::size_t width) {
  return carry<kSide>(before, here, row, width);
}
#endif

template <From kSide>
Carry best_carry() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return carry_avx2<kSide>;
#endif
  return carry_anywhere<kSide>;
}

/// Carries what rows know of the next edge from one to the next, down or up.
template <From kSide>
class Sweep {
 public:
  /// `row` knows something; nullptr: nothing is known before the first row.
  Sweep(const std::int32_t* row, int width)
      : width_(static_cast<std::size_t>(width)), known_(width_ + 2 + kLanes, -kFarthest), next_(known_) {
    for (std::size_t u = 0; row != nullptr && u < width_; ++u) known_[u + 1] = std::min(row[u], 0);
  }

  /// The next row comes to know what the one before and its own pixels to one side know; whether it learned
  /// anything.
  bool take(std::int32_t* row) {
    const bool learned = carry_(known_.data() + 1, next_.data() + 1, row, width_);
    std::swap(known_, next_);
    return learned;
  }

 private:
  Carry carry_ = best_carry<kSide>();
  std::size_t width_;
  std::vector<std::int32_t> known_,
      next_;  // of a row, with a pixel beyond both of its ends, and no lane less
};

}  // namespace

EdgeMap::EdgeMap(int width_px, int height_px)
    : width_(width_px), height_(height_px), pixels_(std::make_unique_for_overwrite<std::int32_t[]>(size())) {
  cv::parallel_for_({0, height_},
                    [&](const cv::Range& some) { std::fill(row(some.start), row(some.end), -kFarthest); });
}

void EdgeMap::draw(const PixelSegment& edge, int number) {
  cv::Mat picture(height_, width_, CV_32SC1, pixels_.get());
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
      Sweep<From::Left> down(nullptr, width_);
      Sweep<From::Right> up(nullptr, width_);
      for (int v = top(band); v < top(band + 1); ++v) down.take(row(v));
      for (int v = top(band + 1) - 1; v >= top(band); --v) up.take(row(v));
    }
  });
  // What a band knows goes on into the next one as far as it is nearer than what that one knows itself.
  for (int band = 1; band < bands; ++band) {
    Sweep<From::Left> down(row(top(band) - 1), width_);
    for (int v = top(band); v < height_ && down.take(row(v)); ++v) continue;
  }
  for (int band = bands - 1; band > 0; --band) {
    Sweep<From::Right> up(row(top(band)), width_);
    for (int v = top(band) - 1; v >= 0 && up.take(row(v)); --v) continue;
  }
}

}  // namespace madori::mapping
