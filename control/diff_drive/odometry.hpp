#pragma once

#include <cstdint>
#include <optional>

#include "control/drive_link/wire.hpp"
#include "core/odometry.hpp"
#include "core/wheels.hpp"

namespace madori::control {

struct OdometryOptions {
  WheelGeometry wheels;
  double max_wheel_speed_radps = 30.0;  ///< a faster wheel is a damaged reading, not a motion
  double reading_noise_rad = 0.01;      ///< added to what a wheel may turn between two readings
  double max_gap_s = 2.0;               ///< after a longer silence the motion in between is not taken
};

enum class OdometryVerdict {
  First,      ///< reference taken, the pose stands
  Moved,      ///< the pose was advanced
  Duplicate,  ///< the same frame again, or one overtaken on the way: ignored
  Jump,       ///< an impossible angle: ignored until the next frame says whether the encoder or the frame was
              ///< wrong
  Restarted,  ///< the encoders count from elsewhere, or after a long silence: new reference, the motion in
              ///< between is unknown
};

struct OdometryCounters {
  std::uint64_t moved = 0, dropped = 0, duplicates = 0, jumps = 0, restarts = 0;
};

/// Dead reckoning from the drive's status frames: encoder wrap, dropped, repeated and late frames, impossible
/// jumps. Steps are timed by the controller's own clock, so that delays on the line do no harm.
class DiffDriveOdometry {
 public:
  /// Throws Error when a length or limit is not positive and finite.
  explicit DiffDriveOdometry(const OdometryOptions& options);

  OdometryVerdict update(const wire::Status& status, Stamp received);

  /// The pose at the last frame that moved it or was taken as reference.
  [[nodiscard]] const OdometryReading& reading() const { return reading_; }
  [[nodiscard]] const OdometryCounters& counters() const { return counters_; }
  /// Base over the last step, for the twist: zero until two frames came.
  [[nodiscard]] double linear_mps() const { return linear_mps_; }
  [[nodiscard]] double angular_radps() const { return angular_radps_; }

 private:
  struct Step {
    double left_rad = 0.0, right_rad = 0.0, time_s = 0.0;
  };
  [[nodiscard]] static Step step_between(const wire::Status& from, const wire::Status& to);
  [[nodiscard]] bool possible(const Step& step) const;
  OdometryVerdict advance(const Step& step, const wire::Status& status, Stamp received);
  OdometryVerdict restart(const wire::Status& status, Stamp received, OdometryVerdict verdict);

  OdometryOptions options_;
  OdometryReading reading_;
  OdometryCounters counters_;
  std::optional<wire::Status> reference_;
  std::optional<wire::Status> doubted_;  ///< jumped away from the reference; the next frame decides
  std::uint16_t last_sequence_ = 0;
  int late_row_ = 0;
  double linear_mps_ = 0.0;
  double angular_radps_ = 0.0;
};

}  // namespace madori::control
