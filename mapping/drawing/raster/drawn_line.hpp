#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// A straight line of the drawing with what is known about it.
struct DrawnLine {
  PixelSegment segment;
  bool solid_face = false;  ///< the side of a fill or of a body; otherwise the middle of a pen stroke
  double stroke_px = 1;     ///< thickness of the pen stroke
  double probability = 1;   ///< that it is a wall
  std::optional<RejectReason> rejected{};  ///< why it is no wall

  [[nodiscard]] double length_px() const { return segment.length_px(); }
  /// Direction, [0, pi): lines have no sense.
  [[nodiscard]] double angle_rad() const {
    const double angle = std::atan2(segment.v2 - segment.v1, segment.u2 - segment.u1);
    return angle < 0 ? angle + std::numbers::pi : angle >= std::numbers::pi ? 0 : angle;
  }
};
using DrawnLines = std::vector<DrawnLine>;

/// The angle between two directions of lines, [0, pi/2].
[[nodiscard]] inline double angle_between(double a_rad, double b_rad) {
  const double difference = std::fmod(std::abs(a_rad - b_rad), std::numbers::pi);
  return std::min(difference, std::numbers::pi - difference);
}

}  // namespace madori::mapping
