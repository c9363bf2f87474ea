#pragma once

#include <map>
#include <optional>
#include <vector>

#include "app/cycle/cycle.hpp"

namespace madori::app {

/// The short drive that tells the mountings: forward, once around, back, all slowly.
struct MountingDriveOptions {
  double way_m = 1.0;
  double turn_rad = 2.0 * 3.14159265358979323846;
  double speed_mps = 0.2;
  double turn_radps = 0.35;
  double patience_s = 10.0;  ///< something stands in the way for so long: it is given up
};

/// Drives it by the wheels alone, needs no place and no drawing. What the lidars see, laid by the mountings
/// that were typed, keeps the vehicle from driving into anything; drive, bumper and protective field stop it.
class MountingManoeuvre {
 public:
  enum class Stage { Standing, Forward, Turning, Back, Settling, Done, Stopped };

  /// `vehicle`: its outline, brakes, limits and lidars, as of the cycle. Throws Error where a wheel's size is
  /// none.
  explicit MountingManoeuvre(CycleConfig vehicle, const MountingDriveOptions& options = {});

  /// What the drive shall do after this input. `odometry`: the wheels as they stand.
  [[nodiscard]] CycleOutput step(const CycleInput& input, const OdometryReading& odometry);
  void stop(Notice why);

  [[nodiscard]] Stage stage() const { return stage_; }
  /// 0 to 1.
  [[nodiscard]] double progress() const;
  /// Why it stands, or was given up; empty while it gets on.
  [[nodiscard]] const Notice& notice() const { return notice_; }

 private:
  void see(const PointCloud<Lidar>& sweep, const Transform2<Odom, Base>& odom_from_base);
  [[nodiscard]] Notice held_by(const CycleInput& input) const;
  [[nodiscard]] VelocityCommand wanted(const Transform2<Odom, Base>& odom_from_base);
  [[nodiscard]] bool is_over(Stamp now) const;
  void go_on(const Transform2<Odom, Base>& odom_from_base, Stamp now);
  [[nodiscard]] double free_share(const Transform2<Odom, Base>& odom_from_base,
                                  const VelocityCommand& v) const;
  [[nodiscard]] bool enables();

  CycleConfig vehicle_;
  MountingDriveOptions options_;
  Stage stage_ = Stage::Standing;
  Notice notice_;
  struct Seen {
    Stamp at{};
    std::vector<Point2<Odom>> points;
  };
  std::map<std::size_t, Seen> seen_;  ///< the newest sweep of each lidar
  std::optional<Stamp> begun_;        ///< of the stage
  std::optional<Stamp> drive_heard_;
  std::optional<Stamp> held_since_;
  std::optional<Stamp> previous_;
  control::wire::Status drive_;
  control::LimitState limits_;
  Transform2<Odom, Base> from_;  ///< where the stage began
  Transform2<Odom, Base> last_;
  double done_ = 0.0;  ///< metres or radians of the stage
  int unarmed_steps_ = 0;
};

}  // namespace madori::app
