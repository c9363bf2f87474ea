#pragma once

#include <vector>

#include "app/trajectory_file.hpp"
#include "core/frames.hpp"
#include "localization/landmarks/landmark_agent.hpp"
#include "sensors/log_record.hpp"

namespace madori::app {

/// One agent's log as it went through the landmark map: dead reckoning at every record, and its sightings.
class AgentTrack {
 public:
  /// Plays the log to its end. `match_scans`: see DeadReckoning. Throws Error on a log without any 2D scan.
  AgentTrack(sensors::LogReader& log, localization::landmarks::LandmarkHub& hub, bool match_scans,
             const std::optional<localization::landmarks::FullPose>& rough_start = {});

  /// The way as the map knows it at the end: between two sightings dead reckoning, its error shared out along
  /// the way. One pose a record; empty where no landmark was ever recognised.
  [[nodiscard]] std::vector<StampedPose> trajectory(const localization::landmarks::LandmarkHub& hub,
                                                    const Transform2<Map, Map>& map_from_origin) const;
  [[nodiscard]] const std::vector<localization::landmarks::Sighting>& sightings() const { return sightings_; }
  [[nodiscard]] int recognised() const;
  [[nodiscard]] double driven_m() const { return records_.empty() ? 0.0 : records_.back().path_m; }

 private:
  struct Record {
    Stamp stamp{};
    Transform2<Odom, Base> odom_from_base;
    double path_m = 0.0;
  };
  void add(Stamp stamp, const Transform2<Odom, Base>& odom_from_base);

  std::vector<Record> records_;
  std::vector<localization::landmarks::Sighting> sightings_;
  std::vector<std::size_t> at_;  ///< record of each sighting
};

}  // namespace madori::app
