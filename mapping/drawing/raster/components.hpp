#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/drawing/gray_image.hpp"

namespace madori::mapping {

/// A horizontal stretch of ink: columns first..last of row v.
struct Run {
  std::int32_t v = 0, first = 0, last = 0;
  std::int32_t component = 0;

  [[nodiscard]] int length() const { return last - first + 1; }
};

/// One 8-connected mark of ink and its bounding box, inclusive.
struct Component {
  int left = 0, top = 0, right = 0, bottom = 0;
  std::int64_t area_px = 0;
  double middle_u = 0, middle_v = 0;  ///< centre of gravity, pixel middles at + 0.5
  double angle_rad = 0;               ///< of the principal axis
  double long_px = 0, short_px = 0;   ///< sides of the rectangle with the same moments

  /// How much of that rectangle is ink: about 1 for a bar or a dot, little for an outline or a letter.
  [[nodiscard]] double fill() const { return static_cast<double>(area_px) / (long_px * short_px); }
  [[nodiscard]] int size() const { return std::max(width(), height()); }
  [[nodiscard]] int width() const { return right - left + 1; }
  [[nodiscard]] int height() const { return bottom - top + 1; }
};

/// All marks of a drawing as runs: memory follows the ink, not the picture.
class Components {
 public:
  /// 8-connected marks of ink; with `of_paper` the 4-connected areas of paper instead, which have no axes.
  explicit Components(const GrayImage& ink, bool of_paper = false);

  [[nodiscard]] const std::vector<Component>& all() const { return components_; }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  /// The component of an ink pixel; -1 on paper.
  [[nodiscard]] int at(int u, int v) const;
  /// Gives every pixel of the components that `chosen` names this value.
  void paint(GrayImage& picture, const std::vector<bool>& chosen, std::uint8_t value) const;

 private:
  void connect_rows();
  void describe();
  void describe_axes();
  [[nodiscard]] std::span<const Run> row(int v) const;

  std::vector<Run> runs_;
  std::vector<std::size_t> row_start_;  // index of the first run of each row, one past the end last
  std::vector<Component> components_;
  int touch_ = 1;  // columns by which runs of neighbouring rows may miss each other
};

}  // namespace madori::mapping
