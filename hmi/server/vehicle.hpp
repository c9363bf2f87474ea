#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/pose_estimate.hpp"
#include "core/velocity_command.hpp"
#include "mapping/site/site.hpp"
#include "planning/route_graph/taught_route.hpp"

namespace madori::hmi {

/// A sentence for a person: the panel's catalogues know it by its code, `text` is the English of the vehicle.
struct Notice {
  std::string code;                           ///< e.g. "obstacle-ahead"; empty where there is nothing to say
  std::map<std::string, std::string> values;  ///< what the catalogue's {placeholders} stand for
  std::string text;
};

/// What a sensor or the drive is doing.
struct DeviceStatus {
  std::string name;
  std::string type;   ///< a kind of lidar, or drive
  std::string title;  ///< of a lidar: its product's name for people; empty: the page has a word for the type
  bool healthy = false;
  double age_s = 0.0;             ///< of the newest data
  std::optional<double> rate_hz;  ///< revolutions or reports a second
  Notice detail;                  ///< what it last said
};

/// Something connected that the site could use.
struct FoundDevice {
  std::string type;     ///< a kind of lidar, or drive
  std::string title;    ///< as of a DeviceStatus
  std::string address;  ///< UDP port or serial port
  bool heard = false;
  Notice detail;
  std::optional<mapping::SensorRecord> sensor;  ///< what to enter below sensors; nothing for a drive
};

/// What one lidar sees now, from above.
struct LidarView {
  std::string name;
  std::string type;
  std::string place;  ///< where it is listened to
  double rate_hz = 0.0;
  double silence_s = 0.0;            ///< since its last good data
  long long lost = 0;                ///< packets or telegrams that never came, since the start
  long long refused = 0;             ///< that came damaged, or of another device
  Notice state;                      ///< heard, silent, or what is wrong with it
  std::vector<Point2<Base>> points;  ///< of its newest sweep, thinned; laid by its mounting as it is saved
};

/// How one lidar was typed and how it was found to be mounted.
struct MountingRow {
  mapping::SensorRecord typed;
  mapping::SensorRecord found;  ///< what was not found is as typed
  std::string known;            ///< all, yaw (place as typed), nothing
  bool height_known = false;
  double sigma_m = 0.0, sigma_deg = 0.0;
  double residual_m = 0.0;  ///< of walls put together from all sweeps
  double tilt_deg = 0.0;    ///< of a lidar that sees the floor
  Notice lack;              ///< why not all was found
};
/// A measurement of the mountings.
struct MountingState {
  std::string state = "idle";  ///< idle, driving, computing, done, stopped
  double progress = 0.0;       ///< of the drive, 0 to 1
  Notice notice;               ///< why it stands or was given up
  std::vector<MountingRow> rows;
};

/// A place where the vehicle may stand.
struct PlaceView {
  Transform2<Map, Base> map_from_base;
  double score = 0.0;  ///< share of what is seen that lies on drawn walls there, 0..1
};

/// How the search for the place stands; places best first.
struct LocateView {
  std::string state =
      "blind";  ///< setting-up, searching (no place yet), ambiguous, located; blind without a scan
  std::vector<PlaceView> places;
};

/// Everything that changes by itself, at one moment.
struct LiveState {
  Stamp stamp{};
  std::string state = "idle";  ///< of docs/reference/states.md
  Notice cause;                ///< why the vehicle stands; empty code while it drives or has nothing to do
  Notice remedy;
  Stamp since{};  ///< of the state
  PoseEstimate pose;
  std::optional<VelocityCommand> velocity;  ///< as the wheels turn; nothing while the drive is silent
  std::optional<double> battery_v;
  std::optional<double> score;  ///< share of the walls seen that lie on drawn ones, 0..1
  double odometer_m = 0.0;      ///< driven since the site began
  bool drivable = false;        ///< the site is complete and loaded
  bool mapping = false;         ///< a map is made by driving by hand
  bool camera = false;          ///< there is a picture
  bool emergency_stop = false;
  std::optional<long long> order_id;
  std::string goal;                         ///< name of the station driven to
  std::vector<Point2<Map>> path;            ///< still to drive
  std::vector<Point2<Map>> blocked;         ///< waypoints that an obstacle covers
  std::shared_ptr<const std::string> scan;  ///< newest returns as a frame of scan_frame.hpp; may be null
  std::vector<Transform2<Map, Base>> particles;
  std::vector<DeviceStatus> devices;
};

/// The answer to a command: done, or refused with the reason.
struct Reply {
  bool accepted = false;
  Notice reason;

  [[nodiscard]] static Reply done() { return {true, {}}; }
  [[nodiscard]] static Reply refused(std::string code, std::string text) {
    return {false, {std::move(code), {}, std::move(text)}};
  }
};

/// A stop of an order.
struct StopView {
  int node = 0;                 ///< ID
  std::string action = "pass";  ///< pass, wait, load, unload
  double wait_s = 0.0;
  bool gone = false;  ///< the station was deleted: the number may be another's by now
};

/// An order as operators see it.
struct OrderView {
  long long id = 0;
  std::vector<StopView> stops;
  int round = 0;       ///< repetitions finished
  int next_stop = 0;   ///< of the current round
  std::string status;  ///< queued, running, done, cancelled, failed
  int repeat = 1;
  Stamp created{};
  Notice detail;
};

struct EventView {
  Stamp stamp{};
  std::string severity;  ///< info, warning, stop
  Notice what;
  Notice remedy;
};

/// What the lidar has seen of a piece (about a metre) of a drawn wall.
struct WallView {
  int id = 0;                   ///< of walls.csv
  int piece = 0;                ///< counted from the wall's start
  Segment2<Map> segment;        ///< as drawn
  std::string state;            ///< unseen, confirmed, missing, displaced
  double share = 0.0;           ///< how far the drawing is to be believed here, 0..1
  double offset_m = 0.0;        ///< of a displaced piece: where it stands, to the left of its direction
  double missed = 0.0;          ///< independent looks through it
  bool surely_missing = false;  ///< so many that the vehicle does not count on it any more
};

/// How often and how long the vehicle stood for a cause.
struct CauseView {
  Notice cause;
  long long count = 0;
  double seconds = 0.0;
};

/// Sums since the site began.
struct StatisticsView {
  long long deliveries = 0;  ///< stops that were served
  double distance_m = 0.0;
  double driving_s = 0.0;
  double standing_s = 0.0;  ///< with an order, or stopped
  std::optional<Stamp> since;
  std::vector<CauseView> causes;  ///< longest first
};

/// How far a map by driving is.
struct MappingView {
  /// none; interrupted: a drive lies there that can go on; reading: it is being read; mapping; finishing
  std::string state = "none";
  double driven_m = 0.0;
  int scans = 0;
  long long keyframes = 0;
  int loops = 0;
  int dropped = 0;                   ///< scans that the computer had no time for
  Notice problem;                    ///< what is wrong with the map, or with keeping the drive
  long long revision = 0;            ///< of walls and points
  std::vector<Segment2<Map>> walls;  ///< so far
  mapping::VehicleRecord vehicle;    ///< what it is made with, or is proposed
  std::vector<mapping::SensorRecord> sensors;
};

/// What the braking tests have measured, and what the record should hold by it.
struct BrakingView {
  struct Stop {
    bool loaded = false;
    double speed_mps = 0.0, deceleration_mps2 = 0.0, latency_s = 0.0, way_m = 0.0;
  };
  /// What the record should hold: the worst of all stops, and nothing better than it holds without a load.
  struct Verdict {
    double deceleration_mps2 = 0.0, reaction_s = 0.0;
    double needs_m = 0.0;      ///< to stand from the site's top speed
    double sees_m = 0.0;       ///< how far ahead the lidar is sure to see something
    double allowed_mps = 0.0;  ///< the top speed that it allows
  };
  bool running = false;
  int stops_now = 0;  ///< of the test that runs or ran last
  int stops_wanted = 0;
  double way_m = 0.0;  ///< that a test needs straight ahead; 0 while the site is not ready to drive
  Notice trouble;      ///< why the last test ended early
  std::vector<Stop> stops;
  std::optional<Verdict> verdict;
};

/// GoOn ends the stay at a stop. Stop stands and ends the order that is under way; Halt stands, whoever asks.
enum class Command { Start, Pause, Resume, Stop, Confirm, GoOn, Halt };

/// The vehicle as the server sees it. Every member may be called from the server's threads at any time and
/// returns at once: the autonomy cycle is never held up by a panel.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  [[nodiscard]] virtual LiveState live() const = 0;
  virtual Reply command(Command command) = 0;
  /// Hold-to-run of one panel, `who`; zero: its button was let go, or it has gone. The vehicle stops by
  /// itself when no further call comes within 250 ms.
  virtual Reply jog(const VelocityCommand& velocity, const void* who) = 0;
  /// `who` is not heard any more: the vehicle stands. Nobody knows whether the button was let go.
  virtual void jog_silent(const void* who) = 0;

  [[nodiscard]] virtual std::vector<OrderView> orders() const = 0;
  /// Orders that have ended, newest first.
  [[nodiscard]] virtual std::vector<OrderView> order_history() const = 0;
  virtual Reply add_order(const std::vector<StopView>& stops, int repeat) = 0;
  virtual Reply repeat_order(long long id) = 0;
  virtual Reply cancel_order(long long id) = 0;
  /// `ids`: the queued orders in their new sequence, all of them.
  virtual Reply arrange_orders(const std::vector<long long>& ids) = 0;

  [[nodiscard]] virtual LocateView locate() const = 0;
  /// Forgets the pose and looks for the place on the whole drawing.
  virtual Reply search_place() = 0;
  /// A person says that the vehicle stands there.
  virtual Reply set_pose(const Transform2<Map, Base>& map_from_base) = 0;
  /// The same although what is seen contradicts: the vehicle drives slowly from there until it agrees.
  virtual Reply insist_on_pose(const Transform2<Map, Base>& /*map_from_base*/) {
    return Reply::refused("not-possible", "this vehicle drives only where it agrees");
  }
  /// An operator's word to the integrator: it stands among the events.
  virtual Reply report(const std::string& /*text*/) {
    return Reply::refused("not-possible", "this vehicle keeps no events");
  }

  /// Drives, stops and measures; Stop ends it. Refused while the vehicle drives.
  virtual Reply start_braking_test(bool /*loaded*/) {
    return Reply::refused("not-possible", "this vehicle measures no brakes");
  }
  [[nodiscard]] virtual BrakingView braking() const { return {}; }

  [[nodiscard]] virtual std::vector<FoundDevice> found_devices() const = 0;
  /// Listens everywhere for devices that the site does not use yet; takes some seconds.
  [[nodiscard]] virtual std::vector<FoundDevice> search_devices() const { return {}; }
  [[nodiscard]] virtual std::vector<LidarView> lidar_views() const { return {}; }
  /// Measures how the lidars are mounted: the vehicle drives a metre forward, once around and back.
  virtual Reply measure_mounting() {
    return Reply::refused("not-possible", "this vehicle does not measure its mountings");
  }
  virtual Reply stop_measuring() { return Reply::done(); }
  [[nodiscard]] virtual MountingState mounting() const { return {}; }
  [[nodiscard]] virtual std::vector<EventView> events(std::size_t newest) const = 0;
  [[nodiscard]] virtual StatisticsView statistics() const = 0;
  /// What is known of every piece of wall; changes slowly, so that asking every few seconds is plenty.
  [[nodiscard]] virtual std::vector<WallView> walls_seen() const { return {}; }
  /// The newest picture of the verification camera as JPEG; null where there is none.
  [[nodiscard]] virtual std::shared_ptr<const std::string> camera_jpeg() const = 0;

  [[nodiscard]] virtual MappingView mapping() const { return {}; }
  /// What was seen so far as a frame of scan_frame.hpp at the origin of the map; null while none is made.
  [[nodiscard]] virtual std::shared_ptr<const std::string> mapping_points() const { return nullptr; }
  /// One sensor of every kind of lidar, where it would be mounted by default.
  [[nodiscard]] virtual std::vector<FoundDevice> lidar_kinds() const { return {}; }
  /// Begins a map by driving, or goes on with one; `anew`: what was driven is forgotten. Throws Error.
  virtual Reply start_mapping(const mapping::VehicleRecord& /*vehicle*/,
                              const std::vector<mapping::SensorRecord>& /*sensors*/, bool /*anew*/) {
    return Reply::refused("not-possible", "this vehicle makes no maps");
  }
  /// Ends it and forgets what was driven.
  virtual Reply drop_mapping() { return Reply::refused("not-possible", "this vehicle makes no maps"); }
  /// Whether it may be finished now; refused with the reason.
  [[nodiscard]] virtual Reply may_finish_mapping() const {
    return Reply::refused("not-mapping", "no map is being made by driving");
  }
  /// Makes the site of it, which takes seconds; the number of walls. Throws Job::Failed, Error.
  virtual std::size_t finish_mapping(
      const std::function<void(const std::string& stage, double share)>& /*progress*/) {
    return 0;
  }
  /// The way that was driven by hand last, on the drawing; empty where there is none.
  [[nodiscard]] virtual std::vector<planning::DrivenPose> driven_way() const { return {}; }

  /// Whether walls, routes, scale or vehicle may be changed now; refused with the reason while it drives.
  [[nodiscard]] virtual Reply may_change_site() const = 0;
  /// What is on the disk has changed: the vehicle takes it as soon as it stands.
  virtual void reload_site() = 0;
};

}  // namespace madori::hmi
