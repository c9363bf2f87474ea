#pragma once

#include <optional>
#include <vector>

namespace madori::mapping {

/// Darkness across a line, at even steps of `step_px` from `first_px` on; 0 is the line as it is known so
/// far.
struct EdgeProfile {
  std::vector<float> darkness;
  double first_px = 0, step_px = 1;

  [[nodiscard]] double at_px(std::size_t i) const { return first_px + static_cast<double>(i) * step_px; }
};

/// Where a profile says that the line is, or which way its ink lies.
struct EdgePlace {
  double offset_px = 0;
  bool ink_follows = false;  ///< of a face: the ink lies on the side of the larger offsets
};

/// The crossing half way between the darkest and the palest, the one nearest to 0.
[[nodiscard]] std::optional<EdgePlace> face_place(const EdgeProfile& profile, double reach_px);

/// The middle between the two flanks of the dark run at 0, each half way down to the palest of its own side.
/// Nothing where a flank is missing or the run is not about `stroke_px` wide: another line crosses there.
[[nodiscard]] std::optional<EdgePlace> stroke_place(const EdgeProfile& profile, double reach_px,
                                                    double stroke_px);

}  // namespace madori::mapping
