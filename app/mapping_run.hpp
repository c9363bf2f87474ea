#pragma once

#include <vector>

#include "app/log_player.hpp"
#include "localization/slam/mapper.hpp"

namespace madori::app {

/// A log through a mapper: what came of it.
struct MappingRun {
  PlayedLog played;
  std::vector<PoseEstimate> causal;               ///< at every record, as known then
  std::vector<localization::MomentPose> at_last;  ///< at every odometry record and scan, as known at the end
  localization::FinishedMap map;
  double finish_s = 0.0;  ///< that the last look took
};

/// Drives the mapper through the log, to its end.
[[nodiscard]] MappingRun run_mapper(sensors::LogReader& log, const LogLidars& lidars,
                                    localization::Mapper& mapper);

/// TUM lines of the poses, moved onto the site.
[[nodiscard]] std::string tum_text(const std::vector<PoseEstimate>& poses, const Transform2<Map, Map>& by);
[[nodiscard]] std::string tum_text(const std::vector<localization::MomentPose>& poses,
                                   const Transform2<Map, Map>& by);

}  // namespace madori::app
