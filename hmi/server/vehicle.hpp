#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/pose_estimate.hpp"
#include "core/velocity_command.hpp"

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
  std::string type;  ///< vlp16, lms1xx, s300, drive
  bool healthy = false;
  double age_s = 0.0;  ///< of the newest data
  std::string detail;  ///< what it last said, in words
};

/// Everything that changes by itself, at one moment.
struct LiveState {
  Stamp stamp{};
  std::string state = "idle";  ///< of docs/reference/states.md
  Notice cause;                ///< why the vehicle stands; empty code while it drives or has nothing to do
  Notice remedy;
  Stamp since{};  ///< of the state
  PoseEstimate pose;
  VelocityCommand velocity;
  std::optional<double> battery_share;  ///< 0..1
  bool emergency_stop = false;
  std::optional<long long> order_id;
  std::string goal;                  ///< name of the station driven to
  std::vector<Point2<Map>> path;     ///< still to drive
  std::vector<Point2<Map>> blocked;  ///< waypoints that an obstacle covers
  std::vector<Point2<Map>> scan;     ///< newest returns
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

/// An order as operators see it.
struct OrderView {
  long long id = 0;
  std::vector<int> stations;  ///< node IDs, in the order of the visit
  std::string status;         ///< queued, running, done, cancelled, failed
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

/// Sums since the site began.
struct StatisticsView {
  long long deliveries = 0;  ///< stops that were served
};

enum class Command { Start, Pause, Resume, Stop, Confirm };

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
  virtual Reply add_order(const std::vector<int>& stations, int repeat) = 0;
  virtual Reply cancel_order(long long id) = 0;

  [[nodiscard]] virtual std::vector<EventView> events(std::size_t newest) const = 0;
  [[nodiscard]] virtual StatisticsView statistics() const = 0;
  /// What is known of every piece of wall; changes slowly, so that asking every few seconds is plenty.
  [[nodiscard]] virtual std::vector<WallView> walls_seen() const { return {}; }
  /// The walls, routes or scale on disk have changed.
  virtual Reply reload_site() = 0;
};

}  // namespace madori::hmi
