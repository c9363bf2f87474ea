#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace madori::app {

/// A sentence for a person. Catalogues in other languages know it by its code.
struct Notice {
  std::string code;                           ///< empty where there is nothing to say
  std::map<std::string, std::string> values;  ///< what the {placeholders} stand for
  std::string text;                           ///< in English

  [[nodiscard]] bool empty() const { return code.empty(); }
  friend bool operator==(const Notice&, const Notice&) = default;
};

struct CatalogueEntry {
  const char* code;
  const char* english;  ///< with {placeholders}
};

/// Why the vehicle stands. docs/reference/states.md lists the same; a test compares them.
enum class Cause : std::uint8_t {
  NoOrder,
  Paused,
  Manual,
  BumperPressed,
  EmergencyStopPressed,
  EmergencyStopOver,
  DriveSilent,
  DriveFault,
  FaultOver,
  NoScan,
  PlaceUnknown,
  PlaceAmbiguous,
  LidarSilent,
  ProtectiveField,
  Loading,
  Unloading,
  OrderStop,
  UnknownNode,
  NoWay,
  NoRoomToTurn,
  DoorNotOpen,
  WallInTheWay,
  SomethingInTheWay,
  UnseenInTheWay,
  HeldBack,
  TimeGap,
  Stopped,
  StoppedOrder,
  HeightUnseen,
  LidarBlind,
  LeftWheelDisobeys,
  RightWheelDisobeys,
  Mapping,
  MappingLost,
  MappingStopped,
  TooLongForWay,
  LidarsSilent,
  LidarHeight,
  LidarLeans,
  LidarYaw,
  StopUnsure,
  StopTaken,
  DriveDeaf,
  WheelsUntold,
  DriveIdle,
  DriveLate,
  FoundElsewhere,
};

/// What a person can do about it.
enum class Remedy : std::uint8_t {
  GiveOrder,
  Resume,
  ManualOff,
  FreeAndConfirm,
  ReleaseAndConfirm,
  LookAndConfirm,
  CheckDrive,
  MendDrive,
  Confirm,
  WaitForPlace,
  CheckLidar,
  ClearField,
  GoOn,
  ByItself,
  ClearOrDraw,
  ClearAround,
  OnceOpen,
  MoveRoute,
  OnceClear,
  ClearWay,
  LookAndResume,
  LookAndGoOn,
  UncoverLidar,
  LookAtWheel,
  DriveToMap,
  DriveBack,
  LookAndDrive,
  CorrectMounting,
  LookAtPlace,
  ClearOrGoOn,
  LookAtPlaceAndResume,
};

inline constexpr std::array kCauses{
    CatalogueEntry{"no-order", "no order"},
    CatalogueEntry{"paused", "paused"},
    CatalogueEntry{"manual", "manual mode"},
    CatalogueEntry{"bumper-pressed", "the bumper is pressed"},
    CatalogueEntry{"emergency-stop-pressed", "the emergency stop is pressed"},
    CatalogueEntry{"emergency-stop-over",
                   "the vehicle was stopped by emergency stop, bumper or loss of power"},
    CatalogueEntry{"drive-silent", "the drive does not answer"},
    CatalogueEntry{"drive-fault", "the drive reports fault {faults}"},
    CatalogueEntry{"fault-over", "the drive had a fault, which is gone"},
    CatalogueEntry{"no-scan", "no scan has come yet"},
    CatalogueEntry{"place-unknown", "not sure where the vehicle is: {reason}"},
    CatalogueEntry{"place-ambiguous", "the vehicle may be in more than one place: {reason}"},
    CatalogueEntry{"lidar-silent", "the lidar is silent"},
    CatalogueEntry{"protective-field", "the safety scanner's protective field is interrupted"},
    CatalogueEntry{"loading", "loading"},
    CatalogueEntry{"unloading", "unloading"},
    CatalogueEntry{"order-stop", "stop of the order"},
    CatalogueEntry{"unknown-node", "node {node} is not in the routes"},
    CatalogueEntry{"no-way", "no way leads to node {node}"},
    CatalogueEntry{"no-room-to-turn", "no room to turn"},
    CatalogueEntry{"door-not-open", "a door or lift is not open far enough"},
    CatalogueEntry{"wall-in-the-way", "the way leads too close to a drawn wall"},
    CatalogueEntry{"something-in-the-way", "something stands in the way"},
    CatalogueEntry{"unseen-in-the-way", "something low stands in the way, too near for the lidar to see"},
    CatalogueEntry{"held-back",
                   "something that the lidar does not see holds the vehicle: it drives and does not get on"},
    CatalogueEntry{"time-gap", "the program stood still, or the computer's clock jumped"},
    CatalogueEntry{"stopped", "stopped at a panel"},
    CatalogueEntry{"stopped-order", "stopped at a panel; order {order} was cancelled"},
    CatalogueEntry{"height-unseen", "no lidar sees whether the door or lift ahead is open high enough"},
    CatalogueEntry{"lidar-blind", "the lidar sees nothing any more in a direction ahead"},
    CatalogueEntry{"left-wheel-disobeys", "the left wheel ran at {turned} m/s and was told {asked} m/s"},
    CatalogueEntry{"right-wheel-disobeys", "the right wheel ran at {turned} m/s and was told {asked} m/s"},
    CatalogueEntry{"mapping", "a map is made by driving"},
    CatalogueEntry{"mapping-lost",
                   "the map does not go on here: what the lidar sees fits nothing seen before"},
    CatalogueEntry{"mapping-stopped", "stopped at a panel while a map is made"},
    CatalogueEntry{"too-long-for-way",
                   "the vehicle does not get to node {node}: a drawn wall stands where it turns"},
    CatalogueEntry{"lidars-silent", "silent: lidar {name}"},
    CatalogueEntry{"lidar-height",
                   "lidar {name} hangs {found} m above the floor that it sees, and {typed} m was typed"},
    CatalogueEntry{"lidar-leans", "lidar {name} leans by {found} degrees against the floor that it sees"},
    CatalogueEntry{
        "lidar-yaw",
        "the vehicle gets where lidar {name} would look at {found} degrees, and {typed} was typed"},
    CatalogueEntry{"stop-unsure", "the vehicle is only to {percent} % sure that this is node {node}"},
    CatalogueEntry{"stop-taken", "something stands at node {node}: the vehicle is {metres} m away from it"},
    CatalogueEntry{"drive-deaf", "the drive answers, but hears no commands"},
    CatalogueEntry{"wheels-untold",
                   "the drive answers, but what it tells of its wheels is late or makes no sense"},
    CatalogueEntry{"drive-idle", "the drive answers, but does not start although it is told to"},
    CatalogueEntry{"drive-late", "commands reach the drive late, or its answers come late"},
    CatalogueEntry{"found-elsewhere",
                   "the vehicle finds itself {metres} m and {degrees} degrees from where its wheels led it"},
};

inline constexpr std::array kRemedies{
    CatalogueEntry{"give-order", "give an order"},
    CatalogueEntry{"resume", "press Resume"},
    CatalogueEntry{"manual-off", "press Resume to end driving by hand"},
    CatalogueEntry{"free-and-confirm", "free the vehicle, then confirm"},
    CatalogueEntry{"release-and-confirm", "release it when all is safe, then confirm"},
    CatalogueEntry{"look-and-confirm", "look around, then confirm"},
    CatalogueEntry{"check-drive", "check its power and its cable"},
    CatalogueEntry{"mend-drive", "have it mended, then confirm"},
    CatalogueEntry{"confirm", "confirm"},
    CatalogueEntry{"wait-for-place", "wait, drive it by hand, or show its place: Where am I?"},
    CatalogueEntry{"check-lidar", "check the lidar's power and network cable"},
    CatalogueEntry{"clear-field", "clear the field, or drive the vehicle out of it by hand"},
    CatalogueEntry{"go-on", "goes on by itself, or press Go on"},
    CatalogueEntry{"by-itself", "goes on by itself"},
    CatalogueEntry{"clear-or-draw", "clear the way, or draw a route"},
    CatalogueEntry{"clear-around", "clear the space around the vehicle"},
    CatalogueEntry{"once-open", "it goes on by itself once open"},
    CatalogueEntry{"move-route", "move the route, or erase the wall"},
    CatalogueEntry{"once-clear", "it goes on by itself once clear"},
    CatalogueEntry{"clear-way", "clear the way: {reason}"},
    CatalogueEntry{"look-and-resume", "look, clear the way, then press Resume"},
    CatalogueEntry{"look-and-go-on", "look whether it is open, then press Go on"},
    CatalogueEntry{"uncover-lidar", "clean the lidar, take away what covers it, check its network cable"},
    CatalogueEntry{"look-at-wheel", "free the wheel, or have its motor or encoder mended, then confirm"},
    CatalogueEntry{"drive-to-map", "drive by hand past every wall, then press Finish"},
    CatalogueEntry{"drive-back", "drive back slowly to where the map was right; it goes on from there"},
    CatalogueEntry{"look-and-drive", "look around, then drive on by hand"},
    CatalogueEntry{"correct-mounting",
                   "correct its mounting in the vehicle step, or press Measure the mounting there"},
    CatalogueEntry{"look-at-place", "look whether it is, then press Go on; else show its place: Where am I?"},
    CatalogueEntry{"clear-or-go-on",
                   "clear it, then it goes on by itself; or press Go on to end the stop here"},
    CatalogueEntry{
        "look-at-place-and-resume",
        "look whether it is there and its lidar sits fast, else show its place (Where am I?); then "
        "press Resume"},
};

/// An event of the cycle, not the cause of a standstill.
inline constexpr CatalogueEntry kTimeGapEvent{"event.time-gap",
                                              "the program stood still, or the computer's clock jumped "
                                              "forward, by {seconds} s; the vehicle stands until "
                                              "it has measured anew"};

/// One of several lidars that the vehicle can do without.
inline constexpr CatalogueEntry kLidarLostEvent{
    "event.lidar-lost",
    "lidar {name} is silent: the vehicle goes on with the others, as "
    "fast as they allow"};
inline constexpr CatalogueEntry kLidarBackEvent{"event.lidar-back", "lidar {name} is heard again"};

/// No lidar that is heard sees who lies on the floor ahead.
inline constexpr CatalogueEntry kFloorUnseenEvent{
    "event.floor-unseen",
    "no lidar sees who lies on the floor ahead: at most {speed} m/s are driven; mount a lidar at 0.2 m or "
    "lower, or enter in site.yaml what else guards him (low_bodies_guarded_by)"};
inline constexpr CatalogueEntry kFloorSeenEvent{
    "event.floor-seen", "a lidar sees who lies on the floor ahead: {speed} m/s are no limit any more"};

/// Pose, memory or what was learned of the drawing does not reach the disk.
inline constexpr CatalogueEntry kNotKeptEvent{
    "event.not-kept",
    "what the vehicle learned cannot be kept: {why}; make room on the disk, or let it be written"};
inline constexpr CatalogueEntry kKeptAgainEvent{"event.kept-again", "what the vehicle learned is kept again"};

[[nodiscard]] const CatalogueEntry& entry(Cause cause);
[[nodiscard]] const CatalogueEntry& entry(Remedy remedy);
/// The notice with its English text. Precondition: `values` names every placeholder of the entry.
[[nodiscard]] Notice notice(const CatalogueEntry& entry, std::map<std::string, std::string> values = {});
[[nodiscard]] Notice notice(Cause cause, std::map<std::string, std::string> values = {});
[[nodiscard]] Notice notice(Remedy remedy, std::map<std::string, std::string> values = {});

}  // namespace madori::app
