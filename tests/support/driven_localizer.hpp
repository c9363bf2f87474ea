#pragma once

#include "localization/localizer/localizer.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::test {

/// Hands a moment of a made-up drive, which has a scan, to a localizer.
inline PoseEstimate take(localization::Localizer& localizer, const DriveMoment& moment) {
  (void)localizer.on_odometry(moment.odometry);
  return localizer.on_scan(moment.scan.stamp, localization::extract_walls(moment.scan, {}));
}

}  // namespace madori::test
