#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/pose_estimate.hpp"
#include "core/velocity_command.hpp"
#include "mapping/site/site.hpp"

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
  std::string type;  ///< a kind of lidar, or drive
  bool healthy = false;
  double age_s = 0.0;             ///< of the newest data
  std::optional<double> rate_hz;  ///< revolutions or reports a second
  Notice detail;                  ///< what it last said
};

/// Something connected that the site could use.
struct FoundDevice {
  std::string type;     ///< a kind of lidar, or drive
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
  std::optional<double> battery_share;      ///< 0..1
  std::optional<double> battery_v;
  std::optional<double> score;  ///< share of the walls seen that lie on drawn ones, 0..1
  double odometer_m = 0.0;      ///< driven since the site began
  bool drivable = false;        ///< the site is complete and loaded
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
  int id = 0;             ///< of walls.csv
  int piece = 0;          ///< counted from the wall's start
  Segment2<Map> segment;  ///< as drawn
  std::string state;      ///< unseen, confirmed, missing, displaced
  double share = 0.0;     ///< how far the drawing is to be believed here, 0..1
  double offset_m = 0.0;  ///< of a displaced piece: where it stands, to the left of its direction
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

/// GoOn ends the stay at a stop. Stop stands and ends the order that is under way; Halt stands, whoever asks.
enum class Command { Start, Pause, Resume, Stop, Confirm, GoOn, Halt };

/// The vehicle as the server sees it. Every member may be called from the server's threads at any time and
/// returns at once: the autonomy cycle is never held up by a panel.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  [[nodiscard]] virtual LiveState live() const = 0;
  virtual Reply command(Command command) = 0;
  /// Hold-to-run. The vehicle stops by itself when no further call comes within 250 ms.
  virtual Reply jog(const VelocityCommand& velocity) = 0;

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

  /// Whether walls, routes, scale or vehicle may be changed now; refused with the reason while it drives.
  [[nodiscard]] virtual Reply may_change_site() const = 0;
  /// What is on the disk has changed: the vehicle takes it as soon as it stands.
  virtual void reload_site() = 0;
};

}  // namespace madori::hmi
