#pragma once

#include "app/cycle/cycle.hpp"

/// The stages of step(), in their order; way.hpp says which part of the state is whose.
namespace madori::app {

/// Drive statuses become odometry, odometry becomes a pose; revolutions correct it.
void localize(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// Where the vehicle will be when it obeys what is sent in this step: pose and commands on their way ->
/// command_pose.
void foresee(CycleState& state, Stamp now, const CycleConfig& config);
/// Braking, from when a command is obeyed: what is driven until then stands in command_pose.
[[nodiscard]] planning::BrakingModel braking_once_obeyed(const CycleConfig& config);
/// Whether the wheels stand, and nothing is on its way that moves them.
[[nodiscard]] bool stands(const CycleState& state);
/// The order's next stop becomes a route and a path; an answered detour replaces it.
void navigate(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// Notices mountings that are not as typed.
void watch_mounting(CycleState& state, const CycleInput& input, const CycleConfig& config,
                    CycleOutput& output);
/// Whether a mounting is so wrong that nothing may be driven by it.
[[nodiscard]] bool mounting_forbids(const MountingWatch& watch);
[[nodiscard]] Notice mounting_notice(const MountingDoubt& doubt, const CycleConfig& config);
/// Says which lidar is not heard any more while the vehicle can do without it, and that it is back.
void say_missed_lidars(CycleState& state, const CycleInput& input, const CycleConfig& config,
                       CycleOutput& output);
/// How long a lidar may be silent: two and a half of its sweeps, where that is longer than usual.
[[nodiscard]] double patience_s(const CycleConfig& config, std::size_t lidar);
/// Which lidars are silent now, by their names: "front, rear".
[[nodiscard]] std::string silent_lidars(const CycleState& state, Stamp now, const CycleConfig& config);
/// How far ahead a leg is sure to be seen by the lidars that are heard.
[[nodiscard]] double sure_range_m(const CycleState& state, Stamp now, const CycleConfig& config);
/// As fast as any point of the vehicle may move by itself, for the sake of who lies on the floor: as the
/// lidars that are heard are sure to have seen him, and where they look over him as slowly as a vehicle that
/// does not see him may drive. No limit where something else guards him.
[[nodiscard]] double low_bodies_mps(const CycleState& state, Stamp now, const CycleConfig& config);
/// The same, and for the sake of who has come too near to be seen.
[[nodiscard]] double unseen_bodies_mps(const CycleState& state, Stamp now, const CycleConfig& config);
/// Says that no lidar sees who lies on the floor; once.
void say_floor_unseen(CycleState& state, const CycleInput& input, const CycleConfig& config,
                      CycleOutput& output);
/// The fastest point of the vehicle's outline at a command.
[[nodiscard]] double outline_mps(const planning::VehicleOutline& vehicle, const VelocityCommand& command);
/// Notices a wheel that does not do what it was told.
void watch_wheels(CycleState& state, const CycleInput& input, const CycleConfig& config);
/// Notices that the vehicle does not get on although it drives; what holds it is remembered as a body.
void watch_effort(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// Keeps where the vehicle has just driven.
void remember_trail(CycleState& state, Stamp now);
/// The acts of recoveries.cpp, each once it is due. A wedged vehicle gets a path back the way it came, where
/// it has just driven and nothing is seen behind it.
void back_out(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// What is kept of the margins is less, or all of them again.
void squeeze(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// A way around is looked for beside the cycle.
void ask_for_detour(CycleState& state, const CycleInput& input, const CycleConfig& config,
                    CycleOutput& output);
/// Another route without the leg that is blocked, where there is one.
void try_another_route(CycleState& state, const CycleInput& input, const CycleConfig& config,
                       CycleOutput& output);
/// From here the way is planned anew.
void end_back_out(CycleState& state);
/// A new path takes the place of the old one.
void take_path(CycleState& state, Path path, const CycleConfig& config);
/// The path ahead against what the scan and the drawing show.
void check_way(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// Without a lidar that sees heights the vehicle stands before each door and lift until an operator, who has
/// looked, says Go on.
void stop_before_doors(CycleState& state, const CycleConfig& config);
/// The operator's word for the one before which it stands.
void allow_door(CycleState& state, const CycleConfig& config);
[[nodiscard]] bool sees_heights(const CycleConfig& config);
/// Events of all kinds move the mode.
void change_mode(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);
/// What following the path from here asks of the wheels, and how far on the path that is.
struct Pursued {
  VelocityCommand command;
  Progress progress;
};
[[nodiscard]] Pursued pursue_way(const CycleState& state, const CycleInput& input, const CycleConfig& config);
/// The end of the path is reached.
void arrive(CycleState& state, Stamp now);
/// The command as far as nothing is met on it; a path is not followed to the centimetre.
[[nodiscard]] VelocityCommand guarded(CycleState& state, const VelocityCommand& wanted,
                                      const CycleConfig& config);
/// The share of a command, 0 to 1, that the guard leaves.
[[nodiscard]] double share_to_go(const CycleState& state, const VelocityCommand& wanted,
                                 const std::vector<Point2<Map>>& obstacles, const CycleConfig& config);
/// Cause and remedy of a standstill; empty while the vehicle may move.
[[nodiscard]] Standstill standstill_of(const CycleState& state, const CycleInput& input,
                                       const CycleConfig& config);

[[nodiscard]] Transform2<Map, Odom> map_from_odom_now(const CycleState& state);
/// Where the source thinks better of where everything around the vehicle lies, what the vehicle remembers of
/// it moves along: it stands where it stood, seen from the vehicle. An estimate that is not finite is not
/// taken: the vehicle is Lost.
void take_pose(CycleState& state, PoseEstimate pose);
/// Keeps how the odometry lies on the map, every half second for half an hour, while the vehicle knows it.
void note_anchor(CycleState& state, Stamp stamp);
/// Confirmed columns around the vehicle, Map frame: their corners, and where they may go on unseen. On the
/// workbench: good until the next call.
const std::vector<Point2<Map>>& obstacle_points(CycleState& state, const CycleConfig& config);
/// Whether what stands at a place is remembered only: no scan has shown it, or its upper part, lately.
[[nodiscard]] bool is_unseen(const CycleState& state, const Point2<Map>& where, Stamp now,
                             const CycleConfig& config);
/// A sweep came: which directions ahead it tells of.
void note_heard(Hearing& hearing, const PointCloud<Base>& sweep, const LidarModel& lidar, Stamp now);
/// When all that driving needs of the lidars had last been heard: the way ahead in somebody's field of view,
/// and a lidar by which the vehicle knows its place. Nothing before that.
[[nodiscard]] std::optional<Stamp> heard_all(const CycleState& state, const CycleConfig& config, Stamp now);
/// Whether a lidar tells where the vehicle is: those that see walls over the equipment do, else all of them.
[[nodiscard]] bool tells_place(const std::vector<LidarModel>& lidars, std::size_t lidar);
/// What a person's word asks of the mode; nothing where it is no matter of modes.
[[nodiscard]] std::optional<ModeEvent> event_of(OperatorWord word);
/// Whether nobody has heard of a device for too long.
[[nodiscard]] bool is_silent(const std::optional<Stamp>& heard, Stamp now, double limit_s);
/// Statuses come, but none that moves the odometry on: a wheel's angle jumps, or they come late. After a gap
/// of the computer's time all stamps are late for a while.
[[nodiscard]] bool are_wheels_untold(const CycleState& state, Stamp now, const CycleConfig& config);
/// A drive that stays idle is given a command without enable, which arms it, after so many with it.
inline constexpr int kStepsToRun = 10;
/// Whether the drive has told for too long that it hears no commands.
[[nodiscard]] bool is_drive_deaf(const CycleState& state, Stamp now, const CycleConfig& config);
/// It obeys commands that are older than the controller waits for them before it stops the wheels itself.
[[nodiscard]] bool is_drive_late(const CycleState& state, Stamp now, const CycleConfig& config);
[[nodiscard]] bool may_drive(LocalizationState state);
/// Whether the vehicle knows where it is, and hears what that needs.
[[nodiscard]] bool is_placed(const CycleState& state);
/// Whether the vehicle knows so surely where it is that goods may be handed over there.
[[nodiscard]] bool is_place_certain(const LocalizationHealth& health);
/// Whether the place lies at a door or a lift of its way, where the vehicle waits instead of driving around.
[[nodiscard]] bool is_at_door(const CycleState& state, const Point2<Map>& place, const CycleConfig& config);
/// Whether a door or lift may be what blocks the way. What is remembered only, low and too near to be seen,
/// is none.
[[nodiscard]] bool waits_for_door(const CycleState& state, const CycleConfig& config);
/// Cause::StopTaken where something that it sees stands at its stop and no way leads around it: a person may
/// end the stop here.
[[nodiscard]] std::optional<Notice> taken_stop(const CycleState& state, const CycleConfig& config);
/// The legs that count as blocked now, in the direction in which the vehicle met what blocks them.
[[nodiscard]] planning::BlockedLegs blocked_now(const Errand& errand, Stamp now, double forget_s);

}  // namespace madori::app
