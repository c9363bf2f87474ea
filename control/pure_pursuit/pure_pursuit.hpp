#pragma once

#include <cstddef>
#include <limits>

#include "control/pure_pursuit/tracked_path.hpp"
#include "core/velocity_command.hpp"

namespace madori::control {

/// Each value says what it trades. Lengths in metres, angles in radians, Map and Base frames.
struct PursuitOptions {
  SpeedLimits speed;
  double look_ahead_s = 0.6;  ///< longer is smoother, shorter follows closer (with min and max below)
  double min_look_ahead_m = 0.35;
  double max_look_ahead_m = 1.2;
  double turn_acceleration_radps2 = 1.0;  ///< braking of a turn on the spot
  double turn_first_rad = 0.6;            ///< a piece whose direction is further off begins with a turn
  double heading_tolerance_rad = 0.005;   ///< at the end of a turn on the spot
  double goal_tolerance_m = 0.004;  ///< left along the path where the vehicle counts as standing at the end
  double creep_mps = 0.03;          ///< slowest speed of the last centimetres
  double creep_radps = 0.05;        ///< slowest rate of the last degrees
  double off_path_m = 0.6;          ///< further from the path the vehicle gives up; so it does facing away
  double sure_sigma_m = 0.05;       ///< position uncertainty up to which full speed is allowed
  double unsure_sigma_m = 0.30;     ///< ... and from which only `unsure_speed_mps` is
  double unsure_speed_mps = 0.2;
};

/// What is remembered between two steps.
struct PursuitState {
  std::size_t piece = 0;
  std::size_t index = 0;
  bool turning = false;  ///< on the spot, towards the direction of `piece`
  bool begun = false;    ///< the piece was entered (its direction was compared with the vehicle's)

  friend bool operator==(const PursuitState&, const PursuitState&) = default;
};

struct PursuitInput {
  Transform2<Map, Base> map_from_base{};
  double position_sigma_m = 0.0;  ///< one sigma, larger axis
  double free_distance_m =
      std::numeric_limits<double>::infinity();  ///< along the path, to where it must stand
  bool turn_free = true;                        ///< whether a turn on the spot sweeps nothing
  double max_speed_mps =
      std::numeric_limits<double>::infinity();  ///< for now (degraded localization, operator)
};

enum class PursuitStatus { Following, Turning, Arrived, OffPath };

struct PursuitOutput {
  PursuitState state;
  PursuitStatus status = PursuitStatus::Following;
  VelocityCommand command;
  double along_m = 0.0;
  double cross_track_m = 0.0;
};

/// One step of regulated pure pursuit (Coulter, CMU-RI-TR-92-01; regulation after Macenski et al. 2023): aims
/// at the point of the path one look-ahead further, slower in curves, before obstacles and while the pose is
/// unsure. Pure: the same arguments give the same result.
[[nodiscard]] PursuitOutput pursue(const TrackedPath& path, const PursuitState& state,
                                   const PursuitInput& input, const PursuitOptions& options);

}  // namespace madori::control
