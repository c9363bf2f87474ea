#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mapping/georeference/scale_estimate.hpp"

namespace madori::app {

/// What the operator gave to `madori scale`, as text.
struct ScaleInputs {
  std::vector<std::string> known;
  std::vector<std::string> control;
  std::string overlay;
  std::string paper;                               ///< "1:200"
  std::optional<double> dpi;                       ///< stronger than the site's
  std::optional<mapping::ScaleEstimate> measured;  ///< while driving (self-calibration)

  [[nodiscard]] bool empty() const;
};

/// Every source by itself, the one to use, and where they disagree.
struct ScaleFindings {
  std::vector<mapping::ScaleEstimate> sources;  ///< given ones first, then what site.yaml holds
  mapping::ScaleEstimate best;                  ///< of the given ones; refused where these disagree
  std::vector<std::string> disagreements;
};

/// Throws Error on inputs that cannot be read; `inputs` must not be empty.
[[nodiscard]] ScaleFindings find_scale(const ScaleInputs& inputs, const mapping::Site& site);

[[nodiscard]] nlohmann::json to_json(const mapping::ScaleEstimate& estimate);
/// The estimate in words, several lines.
[[nodiscard]] std::string describe(const mapping::ScaleEstimate& estimate);

}  // namespace madori::app
