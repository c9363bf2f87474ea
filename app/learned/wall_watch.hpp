#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/learned/latest_look.hpp"
#include "core/pose_estimate.hpp"
#include "localization/drawing_learner/drawing_learner.hpp"
#include "localization/scan_points.hpp"
#include "localization/wall_reliability/wall_reliability.hpp"

namespace madori::app {

/// A piece of drawn wall with what was learned of it.
struct SeenWall {
  localization::WallCell cell;
  localization::WallState state = localization::WallState::Unseen;
  double share_in_place = 0.0;  ///< 0..1
  double offset_m = 0.0;        ///< of a displaced piece, to the left of its direction
  double missed = 0.0;          ///< independent looks through it
  bool surely_missing = false;  ///< so many that localization leaves it out
};

/// What the running vehicle learns of the drawing: for the panel, and for the site's keeper. It looks on
/// only, on a thread of its own: the drive under way does not depend on it. Begins with what earlier drives
/// left with the site.
class WallWatch {
 public:
  /// `sensor`: where the lidar sits, Base frame. `learned`: reliability.csv; it need not exist.
  WallWatch(const mapping::Walls& walls, const Point2<Base>& sensor, const std::filesystem::path& learned);

  /// On the cycle's thread, after every scan: copies one now and then, while the place is sure. True where it
  /// did.
  bool see(const localization::ScanPoints& points, const PoseEstimate& pose);
  /// From any thread.
  [[nodiscard]] std::vector<SeenWall> seen() const;
  /// What reliability.csv is to hold, and the scans that tell the drawing's scale. From any thread.
  [[nodiscard]] std::string reliability_text() const;
  [[nodiscard]] std::vector<localization::CalibrationKeyframe> keyframes() const;
  /// Scans that were looked at so far.
  [[nodiscard]] std::size_t looks() const;

 private:
  struct Look {
    localization::ScanPoints points;
    PoseEstimate pose;
  };

  Point2<Base> sensor_;
  std::optional<Transform2<Map, Base>> handed_;  ///< pose of the last scan that was copied
  mutable std::mutex mutex_;                     ///< of what was learned
  localization::DrawingLearner learner_;
  std::size_t looks_ = 0;
  LatestLook<Look> looks_taken_;  ///< last: its thread uses all of the above
};

}  // namespace madori::app
