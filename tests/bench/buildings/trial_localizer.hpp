#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "core/pose_hypothesis.hpp"
#include "localization/scan_points.hpp"
#include "localization/warp/bent_drawing.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::bench {

/// What localizes in a drive of the bench, from the points on walls of either lidar.
class TrialLocalizer {
 public:
  TrialLocalizer() = default;
  TrialLocalizer(const TrialLocalizer&) = delete;
  TrialLocalizer& operator=(const TrialLocalizer&) = delete;
  virtual ~TrialLocalizer() = default;

  /// As app::PoseSource.
  virtual void set_places(const std::vector<Point2<Map>>& drawn) = 0;
  virtual PoseEstimate on_odometry(const OdometryReading& reading) = 0;
  virtual void on_scan(Stamp stamp, const localization::ScanPoints& points, const Point2<Base>& sensor) = 0;
  virtual void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) = 0;
  virtual void search_anew() = 0;
  /// Where it may be, likeliest first.
  [[nodiscard]] virtual std::vector<PoseHypothesis> hypotheses() const = 0;
  /// How likely its pose is right within 0.5 m and 10 degrees, by its own word, 0..1.
  [[nodiscard]] virtual double said() const = 0;
  /// How the drawing lies in the building that the poses are of; null: as drawn.
  [[nodiscard]] virtual std::shared_ptr<const localization::BentDrawing> bent() const { return nullptr; }
};

/// What --source may name.
[[nodiscard]] std::vector<std::string> localizer_names();
/// Precondition: one of localizer_names().
[[nodiscard]] std::unique_ptr<TrialLocalizer> make_trial_localizer(const std::string& name,
                                                                   const mapping::Walls& drawing);

}  // namespace madori::bench
