#pragma once

#include <memory>
#include <vector>

#include "core/odometry.hpp"
#include "core/point_cloud.hpp"
#include "core/pose_estimate.hpp"
#include "core/pose_hypothesis.hpp"

namespace madori::localization {
struct BentDrawing;
struct RememberedParts;
}  // namespace madori::localization

namespace madori::app {

/// What the cycle asks of localization. Estimates are the building's metres, laid rigidly on the drawing;
/// what a person says and reads are places on the drawing. Deterministic: the same calls give the same poses
/// bit for bit, is_thinking() alone excepted.
class PoseSource {
 public:
  PoseSource() = default;
  PoseSource(const PoseSource&) = delete;
  PoseSource& operator=(const PoseSource&) = delete;
  virtual ~PoseSource() = default;

  /// Before all else: the places of the routes, on the drawing. Where they lie in the building is told with
  /// how the drawing lies there.
  virtual void set_places(const std::vector<Point2<Map>>& /*drawn*/) {}
  /// The pose at a reading of the wheels.
  virtual PoseEstimate on_odometry(const OdometryReading& reading) = 0;
  /// One revolution, Base frame at its stamp, already compensated for the motion during it; `odom_from_base`
  /// is where the wheels were at that stamp. What was learned shows in the next on_odometry().
  virtual void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) = 0;
  /// A person says that the vehicle stands about there at the newest reading of the wheels. It is believed
  /// when the next revolutions fit a pose within a few sigma; otherwise the place is sought everywhere.
  virtual void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) = 0;
  /// Forgets the pose: the place is sought anew on the whole drawing.
  virtual void search_anew() = 0;
  /// Whether what it thinks over beside the cycle is not finished: an input of the next step, as time
  /// decides.
  [[nodiscard]] virtual bool is_thinking() const { return false; }
  /// In this step that is so: nothing waits for it. Where it is not said, what is due is waited for.
  virtual void set_thinking(bool /*thinking*/) {}
  /// Where the vehicle may be at the newest reading of the wheels, likeliest first; empty before a
  /// revolution.
  [[nodiscard]] virtual std::vector<PoseHypothesis> hypotheses() const = 0;
  /// How the drawing is believed to lie in the building; null: as drawn.
  [[nodiscard]] virtual std::shared_ptr<const localization::BentDrawing> bent() const { return nullptr; }
  /// What it remembers of the building, for the next start; null where it is not sure enough to be kept.
  [[nodiscard]] virtual std::shared_ptr<const localization::RememberedParts> remembered() const {
    return nullptr;
  }
};

}  // namespace madori::app
