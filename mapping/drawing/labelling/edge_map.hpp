#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// What edge crosses a pixel of a sheet, and where none does how far the next one is. One number a pixel says
/// either: rays that cross the sheet wait for memory once a step.
class EdgeMap {
 public:
  static constexpr std::int32_t kUnit = 1 << 16;  ///< of distances, a pixel

  EdgeMap() = default;
  EdgeMap(int width_px, int height_px);

  /// Edge `number`; what is drawn later lies above.
  void draw(const PixelSegment& edge, int number);
  /// To call once all edges are drawn. On several threads, with the same result as on one.
  void measure_distances();

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  /// The edge that crosses a pixel (row-major), -1 where none does.
  [[nodiscard]] int edge_at(std::size_t pixel) const { return std::max(pixels_[pixel], -1); }
  /// Pixels to the next edge, 0 on it: over steps of 0.955 across and 1.3693 aslant (G. Borgefors, "Distance
  /// transformations in digital images", CVGIP 34, 1986, as OpenCV's DIST_L2 with a mask of 3).
  [[nodiscard]] float clear_px(std::size_t pixel) const {
    return static_cast<float>(-std::min(pixels_[pixel], 0)) * (1.0F / kUnit);
  }
  /// Whether the next edge is further than some pixels.
  [[nodiscard]] bool is_clear(std::size_t pixel, double px) const {
    return pixels_[pixel] < -static_cast<std::int32_t>(px * kUnit);
  }
  /// The first of the pixels from `at` to `end` whose next edge is no further than that; `end` where there is
  /// none.
  [[nodiscard]] std::size_t end_of_clear(std::size_t at, std::size_t end, double px) const {
    const auto nearest = -static_cast<std::int32_t>(px * kUnit);
    for (; at + 8 <= end; at += 8) {  // eight at once, for most of a drawing is paper
      std::int32_t all = -1;
      for (std::size_t k = 0; k < 8; ++k) all &= pixels_[at + k] - nearest;
      if (all >= 0) break;
    }
    while (at < end && pixels_[at] < nearest) ++at;
    return at;
  }
  /// Has the processor bring a pixel near while it does something else.
  void fetch(std::size_t pixel) const { __builtin_prefetch(&pixels_[pixel]); }

 private:
  [[nodiscard]] std::int32_t* row(int v) {
    return pixels_.get() + static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
  }

  int width_ = 0, height_ = 0;
  std::unique_ptr<std::int32_t[]> pixels_;  // an edge's number, or a distance below 0
};

}  // namespace madori::mapping
