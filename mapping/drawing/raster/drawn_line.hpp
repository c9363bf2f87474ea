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
  bool solid_face = false;  ///< the outline of a solid fill; otherwise the middle of a pen stroke
  double stroke_px = 1;     ///< thickness of the ink under it
  double residual_px = 0;   ///< root mean square distance of its pixels
  int chain = -1;           ///< the bent line it is a piece of; -1 = straight from the Hough transform
  std::optional<RejectReason> rejected;  ///< set by the first stage that knows it is no wall
  double probability = 1;  ///< that it is a wall
  bool pale = false;       ///< an edge in which no ink was found

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
