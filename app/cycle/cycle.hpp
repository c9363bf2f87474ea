#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cycle/modes.hpp"
#include "app/cycle/mounting_watch.hpp"
#include "app/cycle/notice.hpp"
#include "app/cycle/pose_source.hpp"
#include "app/cycle/safety_rules.hpp"
#include "app/cycle/site_in_building.hpp"
#include "app/cycle/way.hpp"
#include "app/orders/order.hpp"
#include "control/diff_drive/odometry.hpp"
#include "control/drive_link/wire.hpp"
#include "control/limits/limits.hpp"
#include "control/prediction/coming_pose.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"
#include "control/wheel_watch/wheel_watch.hpp"
#include "core/laser_scan.hpp"
#include "core/lidar_model.hpp"
#include "core/ring.hpp"
#include "planning/detour/detour_planner.hpp"
#include "planning/obstacle_check/motion_guard.hpp"
#include "planning/obstacle_check/moving_objects.hpp"
#include "planning/obstacle_check/obstacle_field.hpp"
#include "planning/obstacle_check/out_of_sight.hpp"
#include "planning/route_graph/route_search.hpp"
#include "planning/route_graph/vehicle_fit.hpp"
#include "planning/waypoints/waypoints.hpp"
#include "sensors/device_clock.hpp"
#include "sensors/raw_packet.hpp"

namespace madori::app {

/// What does not change while the cycle runs. Times in seconds, lengths in metres.
struct CycleConfig {
  planning::RouteGraph routes;  ///< as drawn, and so are the walls
  std::shared_ptr<const planning::WallGrid> walls = std::make_shared<const planning::WallGrid>();
  std::vector<planning::TightCorner> tight_corners;  ///< of the routes, for this vehicle
  control::OdometryOptions odometry;
  control::PursuitOptions pursuit;
  control::LimitOptions limits;
  control::WheelWatchOptions wheel_watch;
  control::WheelResponse response;
  planning::CheckOptions check;
  planning::GuardOptions guard;
  double sure_range_m =
      planning::PathCheck::kFree;                  ///< within which a standing body is sure to be seen ahead
  double sure_low_m = planning::PathCheck::kFree;  ///< likewise who lies on the floor
  std::string low_bodies_guarded_by;  ///< what else guards him, as the site says; empty: nothing does
  planning::FieldOptions field;
  planning::MoverOptions movers;
  planning::WaypointOptions waypoints;
  std::vector<LidarModel> lidars;  ///< clouds and scans name theirs by its place here
  planning::RouteMetric metric = planning::RouteMetric::Hops;
  std::vector<SafetyRule> safety_rules = standard_safety_rules();
  double look_ahead_m = 7.0;  ///< of the path, checked for obstacles
  /// Before the vehicle's front, whatever the lidars see.
  [[nodiscard]] double looked_at_m() const {
    return std::min(look_ahead_m, field.reach_m - check.vehicle.front_m);
  }
  double care_speed_mps = 0.4;         ///< beside something near
  double narrow_speed_mps = 0.2;       ///< with less than the ordinary margins
  double degraded_speed_mps = 0.4;     ///< while localization is degraded
  double drive_silent_s = 0.3;         ///< without a status of the drive: fault
  double lidar_silent_s = 0.35;        ///< without a sweep: stand; longer for slow ones (patience_s)
  double gap_s = 0.25;                 ///< between two steps: the drive has stopped by itself
  double detour_after_s = 1.5;         ///< something must stand so long before a way around is looked for
  double detour_again_s = 4.0;         ///< between two searches
  double reroute_after_s = 25.0;       ///< then the blocked leg is left out of a new route
  double door_reroute_after_s = 60.0;  ///< likewise before a door or lift, which may be about to open
  double mover_stays_after_s = 5.0;    ///< what stirs in one place for so long is no mover
  double squeeze_after_s = 10.0;       ///< where no way has all of its margins it goes on with less
  double back_out_after_s = 12.0;      ///< a wedged vehicle goes back the way it came
  double back_out_m = 0.8;             ///< ... so far
  double back_out_mps = 0.15;          ///< ... so fast
  double out_of_field_mps = 0.15;      ///< by hand, while a protective field is interrupted
  double trail_fresh_s = 60.0;         ///< something may have been put behind a vehicle that stood for longer
  double forget_block_s = 180.0;       ///< a leg that was found blocked counts as free again
  double clear_for_s = 0.6;            ///< the way must have been free so long before the vehicle goes on
  double door_zone_m = 3.0;    ///< around a door or lift node nothing is driven around, only waited for
  double jog_timeout_s = 0.3;  ///< a held key that is silent for longer stops the vehicle
  bool mapping = false;  ///< a map is made by driving by hand: no routes, no walls, nothing drives itself
};

/// Recordings hold the numbers of these words: new ones go to the end.
enum class OperatorWord {
  Pause,
  Resume,
  Confirm,
  ManualOn,
  ManualOff,
  Jog,
  GoOn,
  ForgetObstacles,
  SetPose,
  SearchPose,
  Stop,  ///< stands in every mode, also by hand, and ends the order that is under way
  Halt   ///< the same by anybody: the order stays
};

/// Where a person says that the vehicle stands.
struct GivenPose {
  Point2<Map> position;
  double yaw_rad = 0.0;
  PoseSigma sigma;

  friend bool operator==(const GivenPose&, const GivenPose&) = default;
};

struct OperatorCommand {
  OperatorWord word = OperatorWord::Pause;
  VelocityCommand jog = {};   ///< of Jog
  GivenPose given_pose = {};  ///< of SetPose
};

/// Everything that reaches the cycle from outside since the step before. A recording holds these.
struct CycleInput {
  Stamp now{};
  std::vector<control::wire::Status> drive;
  Duration drive_behind{};                  ///< what it was told, by the newest of them
  std::vector<PointCloud<Lidar>> clouds;    ///< whole revolutions
  std::vector<LaserScan> scans;             ///< of planar lidars
  std::vector<std::int64_t> firings_us;     ///< the lidar's own time of each cloud's begin, for recordings
  std::vector<sensors::RawPacket> packets;  ///< what they were assembled from, for recordings
  bool thinking = false;                    ///< localization's thinking beside the cycle is not finished
  bool protective_stop = false;             ///< a certified scanner's protective field is interrupted
  std::vector<OperatorCommand> commands;
  std::optional<Order> order;  ///< the running order as it is stored
  std::optional<planning::DetourAnswer> detour;
};

/// Why the vehicle stands, for people.
struct Standstill {
  Notice cause;  ///< empty while it drives
  Notice remedy;
  Stamp since{};
};

struct CycleOutput {
  VelocityCommand command;
  bool enable = false;          ///< of the drive
  bool computed_lidar = false;  ///< a revolution was worked on in this step
  std::optional<planning::DetourRequest> detour_wanted;
  std::optional<Target> stop_done;
  std::optional<std::pair<std::int64_t, std::string>> order_refused;
  std::vector<std::string> events;  ///< one line each
};

/// What was asked of the drive since the vehicle last got on, and from where.
struct Effort {
  Transform2<Map, Base> from;
  Stamp at{};              ///< by the drive's clock: a drive that lags behind has had less time to move
  double driven_s = 0.0;   ///< the drive was asked to move
  double asked_m = 0.0;    ///< of way, turns counted at the outline
  double direction = 1.0;  ///< -1 backwards
};

/// When a lidar was heard, and when it last saw anything in each direction ahead.
struct Hearing {
  static constexpr std::size_t kBearings = 9;  ///< every 15 degrees within 60 of ahead
  std::optional<Stamp> heard;
  std::array<std::optional<Stamp>, kBearings> seen;
};

/// Who moves, as one lidar sees it. Its looks are compared with its own: two lidars see two sides of a
/// person, at two moments, and one that looks elsewhere has not lost him.
struct MoverWatch {
  Stamp looked{};  ///< of its newest sweep that was looked at
  planning::MovingObjects objects;
  planning::OutOfSight out_of_sight;
};

/// How far beside where the wheels led it the vehicle finds itself.
struct Elsewhere {
  double metres = 0.0;
  double degrees = 0.0;
};

/// How the odometry lay on the map at some moment: what was seen then stands there, however the odometry has
/// drifted since.
struct Anchor {
  Stamp at{};
  Transform2<Map, Odom> map_from_odom;
};

/// Room that the stages of a step work in. Nothing in it lasts: it is kept so that a step asks the heap for
/// none.
struct Workbench {
  PointCloud<Lidar> scan;              ///< a planar lidar's, as points
  PointCloud<Base> sweep;              ///< the one at hand
  std::vector<Point2<Base>> within;    ///< ... its returns within the vehicle's outline
  std::vector<Point2<Map>> obstacles;  ///< corners of the confirmed columns
  std::vector<Point2<Map>> set_back;   ///< the same, to leave those that are within the margins
  std::vector<planning::Mover<Map>> movers;
  planning::PathChecker checker;
  Path turn;  ///< on the spot
};

/// Everything the cycle remembers. It moves from step to step.
struct CycleState {
  CycleState(const CycleConfig& config, std::unique_ptr<PoseSource> source);

  Mode mode = Mode::Paused;  ///< nothing drives after a start until the operator lets it
  Standstill standstill;
  control::DiffDriveOdometry odometry;
  Ring<OdometryReading> track;  ///< of the last seconds, for motion compensation
  std::unique_ptr<PoseSource> localization;
  std::shared_ptr<const SiteInBuilding> site;  ///< routes and walls where they stand
  PoseEstimate pose;
  Transform2<Map, Map> moved;  ///< as the newest pose has it
  control::SentCommands sent;
  Transform2<Map, Base> command_pose;  ///< where the vehicle will be when it obeys what is sent in this step
  planning::ObstacleField obstacles;
  Ring<Anchor> anchors;  ///< one every half second while the vehicle knew where it was, oldest first
  std::vector<MoverWatch> movers;  ///< of each lidar
  control::wire::Status drive;
  std::optional<Stamp> drive_heard;
  sensors::DeviceClock drive_clock;
  std::int64_t drive_us = 0;          ///< the controller's clock, unwrapped
  bool drive_stopped = false;         ///< by a status of this step: by hand, bumper or loss of power
  bool drive_faulty = false;          ///< by a status of this step
  std::optional<Stamp> drive_deaf;    ///< since when it tells that it hears no commands
  std::optional<Stamp> drive_late;    ///< when it last obeyed a command that was too old
  std::vector<Hearing> lidars_heard;  ///< each
  std::optional<Stamp> lidar_heard;   ///< since when something that driving needs is missing
  std::optional<Stamp> previous;
  std::optional<Stamp> gap;  ///< the first step after a time without steps, until something was measured anew
  Stamp begun{};             ///< of the first step: before, no device could be heard
  bool stopped = false;      ///< by a person at a panel, until the next Resume
  std::optional<std::int64_t> stopped_order;  ///< that ended with it
  /// Where on the drawing the wheels' way lay when the place was last known; nothing since a person had the
  /// vehicle in hand or told the place.
  std::optional<Transform2<Map, Odom>> drawing_from_odom;
  std::optional<Elsewhere> elsewhere;  ///< it finds itself, until a person has looked: the next Resume
  VelocityCommand jog;
  Stamp jog_heard{};
  std::optional<Stamp> jog_held;  ///< since when the guard leaves nothing of what is asked by hand
  Errand errand;
  Way way;
  Progress progress;
  Ahead ahead;
  Block block;
  DetourSearch detour;
  Ring<Transform2<Map, Base>> trail;  ///< where it has just driven
  Stamp trail_at{};                   ///< of its last pose
  std::optional<Effort> effort;       ///< while it works on an order
  control::LimitState limits;
  control::WheelWatch wheels;
  Stamp wheels_at{};                                     ///< of the reading they were last judged by
  std::optional<control::DisobedientWheel> disobedient;  ///< until a person confirms
  int unarmed_steps = 0;                                 ///< in a row that it was to run and stayed idle
  MountingWatch mounting;
  std::vector<char> lidars_missed;  ///< each: it is silent, and that was said
  bool floor_unseen = false;        ///< it drives slowly since nobody sees who lies before it; that was said
  Workbench bench;
};

struct StepResult {
  CycleState state;
  CycleOutput output;
};

/// One step of the autonomy cycle, from what arrived to what the drive shall do. Pure: it reads no clock, no
/// file and no socket, so that a recorded run replays bit for bit.
[[nodiscard]] StepResult step(CycleState state, const CycleInput& input, const CycleConfig& config);

}  // namespace madori::app
