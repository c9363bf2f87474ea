#pragma once

#include <vector>

#include "mapping/drawing/gray_image.hpp"

namespace madori::mapping {

/// The brightness of the empty paper over the drawing: uneven light, folds, yellowed corners, tinted floors.
/// A coarse grid, one value a block, bilinear between block middles.
class Paper {
 public:
  /// The bright end (90th percentile) of every block, with blocks that ink fills taken from their neighbours.
  explicit Paper(const GrayImage& image);

  [[nodiscard]] double level() const { return level_; }  ///< of most of the drawing
  [[nodiscard]] bool is_even() const { return even_; }
  [[nodiscard]] double at(int u, int v) const;
  /// The levels of one row into `out` (width values).
  void row(int v, std::vector<float>& out) const;

 private:
  void fill_from(const GrayImage& image);

  int columns_ = 0, rows_ = 0;
  std::vector<float> blocks_;
  double level_ = 255;
  bool even_ = true;
};

}  // namespace madori::mapping
