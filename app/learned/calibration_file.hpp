#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "localization/self_calibration/self_calibration.hpp"
#include "mapping/georeference/scale_estimate.hpp"
#include "mapping/site/site.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

inline constexpr const char* kCalibrationFile = "self_calibration.yaml";

/// self_calibration.yaml: the strain with its covariance, and the fingerprint of the walls it is of.
[[nodiscard]] std::string calibration_yaml(const localization::SelfCalibration& found,
                                           const mapping::Walls& walls);
/// Throws Error where the file is missing, damaged, or of other walls than the site's, with what to do.
[[nodiscard]] localization::SelfCalibration load_calibration(const std::filesystem::path& site,
                                                             const mapping::Walls& walls);
/// Keeps the more certain of `found` and what the site holds of the same walls. False where the old one
/// stays, or `found` is not certain to 1 % along any axis.
bool keep_calibration(const std::filesystem::path& site, const mapping::Walls& walls,
                      const localization::SelfCalibration& found);

/// For people: "the drawing seems 1.02 % +- 0.05 % too large along x, ...".
[[nodiscard]] std::string describe(const localization::SelfCalibration& found);
[[nodiscard]] nlohmann::json to_json(const localization::SelfCalibration& found);
/// The one scale that fits best, as a source for `madori scale`; refused where it is less certain than 0.3 %.
[[nodiscard]] mapping::ScaleEstimate scale_of(const localization::SelfCalibration& found,
                                              const mapping::ScaleRecord& now);

}  // namespace madori::app
