#include "mapping/drawing/raster/detection_options.hpp"

#include <cmath>

namespace madori::mapping {
namespace {

bool outside(const std::optional<double>& value, double low, double high) {
  return value && !(std::isfinite(*value) && *value >= low && *value <= high);
}

}  // namespace

std::string DetectionOptions::why_invalid() const {
  if (outside(threshold, 1, 254)) return "the threshold must lie between 1 and 254";
  if (outside(min_wall_length_px, 0, 1e6)) return "the shortest wall must be 0 pixels or more";
  if (outside(min_thickness_px, 1, 1e4)) return "the least thickness must be 1 pixel or more";
  if (outside(close_gap_px, 0, 1e4)) return "the gap to close must be 0 pixels or more";
  if (outside(m_per_px, 1e-6, 1e3)) return "the scale must be a positive number of metres per pixel";
  if (outside(strictness, 0, 1e3)) return "the strictness must be 0 or more";
  return {};
}

}  // namespace madori::mapping
