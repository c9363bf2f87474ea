#include "mapping/drawing/raster/detection_options.hpp"

#include <cmath>

namespace madori::mapping {
namespace {

bool outside(const std::optional<double>& value, double low, double high) {
  return value && !(std::isfinite(*value) && *value >= low && *value <= high);
}

}  // namespace

std::string DetectionOptions::why_invalid() const {
  if (outside(min_wall_length_px, 0, 1e6)) return "the shortest wall must be 0 pixels or more";
  if (outside(close_gap_px, 0, 1e4)) return "the gap to close must be 0 pixels or more";
  if (outside(strictness, 0, 1e3)) return "the strictness must be 0 or more";
  return {};
}

}  // namespace madori::mapping
