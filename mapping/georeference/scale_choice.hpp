#pragma once

#include <string>
#include <vector>

#include "mapping/georeference/scale_estimate.hpp"

namespace madori::mapping {

/// The best of several ways to one scale.
struct ScaleChoice {
  ScaleEstimate best;
  std::vector<ScaleEstimate> sources;
  std::vector<std::string> disagreements;  ///< not empty: the best is refused
};

/// The better verdict, then the smaller uncertainty, one that is verified before one that is not; a place on
/// Earth comes from whichever source knows one. Sources that disagree refuse each other. Precondition: at
/// least one source.
[[nodiscard]] ScaleChoice choose_scale(std::vector<ScaleEstimate> sources);

}  // namespace madori::mapping
