#pragma once

#include <algorithm>
#include <opencv2/core/types.hpp>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// An endless line, pixels.
struct FittedLine {
  cv::Point2d middle, direction;  ///< unit length

  [[nodiscard]] double along(double u, double v) const { return (cv::Point2d(u, v) - middle).dot(direction); }
  [[nodiscard]] double across(double u, double v) const {
    return direction.cross(cv::Point2d(u, v) - middle);
  }
  [[nodiscard]] cv::Point2d at(double along, double across) const {
    return middle + along * direction + across * cv::Point2d(-direction.y, direction.x);
  }
};

/// Through both ends of a segment of some length.
[[nodiscard]] inline FittedLine line_through(const PixelSegment& s) {
  const double length = std::max(1e-9, s.length_px());
  return {{0.5 * (s.u1 + s.u2), 0.5 * (s.v1 + s.v2)}, {(s.u2 - s.u1) / length, (s.v2 - s.v1) / length}};
}

}  // namespace madori::mapping
