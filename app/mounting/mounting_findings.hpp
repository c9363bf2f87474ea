#pragma once

#include <string>
#include <vector>

#include "app/cycle/notice.hpp"
#include "localization/mounting/mounting_calibration.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {

/// Of one lidar: how it was typed and how it was found to hang.
struct MountingFinding {
  mapping::SensorRecord typed;
  mapping::SensorRecord found;  ///< what was not found is as typed
  localization::FoundMounting measured;
  Notice lack;  ///< why not all was found, or with which wheels it was; empty where nothing is to be said

  [[nodiscard]] double apart_m() const;
  [[nodiscard]] double turned_deg() const;
  [[nodiscard]] double higher_m() const { return found.z_m - typed.z_m; }
  [[nodiscard]] double tilt_deg() const;
};

/// What a calibration of the site's `sensors` found, in their order.
[[nodiscard]] std::vector<MountingFinding> mounting_findings(
    const localization::MountingCalibration& found, const std::vector<mapping::SensorRecord>& sensors);

/// For a terminal: a paragraph a lidar, typed against found, with sigmas and residuals; how the lidars agree;
/// the wheels.
[[nodiscard]] std::string mounting_text(const localization::MountingCalibration& found,
                                        const std::vector<MountingFinding>& findings);

/// "all", "yaw" or "nothing", for JSON and the panel.
[[nodiscard]] std::string known_word(localization::MountingKnown known);

}  // namespace madori::app
