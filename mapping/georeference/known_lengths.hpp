#pragma once

#include <string>
#include <vector>

#include "mapping/georeference/scale_estimate.hpp"

namespace madori::mapping {

/// A length that somebody measured, or that a dimension line states, between two drawing pixels.
struct KnownLength {
  double u1 = 0.0;
  double v1 = 0.0;
  double u2 = 0.0;
  double v2 = 0.0;
  double metres = 0.0;

  [[nodiscard]] double pixels() const;
};

/// "u1,v1,u2,v2=METRES". Throws Error on anything else, on lengths that are not positive and on two equal
/// points.
[[nodiscard]] KnownLength parse_known_length(const std::string& text);

/// Throws Error on an end that lies off the drawing.
void require_on_drawing(const std::vector<KnownLength>& lengths, const DrawingRecord& drawing);

/// Least squares of metres = scale * pixels. A length that contradicts the others is named when there are at
/// least three (leave-one-out); of two it cannot be told which one is wrong, and that is said. Throws Error
/// on an empty list.
[[nodiscard]] ScaleEstimate fit_known_lengths(const std::vector<KnownLength>& lengths);

}  // namespace madori::mapping
