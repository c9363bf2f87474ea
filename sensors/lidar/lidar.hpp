#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <variant>

#include "core/laser_scan.hpp"
#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"

namespace madori::sensors {

/// One sweep of a lidar that has become whole, Lidar frame, not deskewed.
struct LidarSweep {
  std::variant<PointCloud<Lidar>, LaserScan> seen;
  std::int64_t device_us = 0;  ///< the device's own time at its begin
  std::string stop;            ///< why the device itself asks the vehicle to stand; empty: it does not
};
/// May move the sweep away. Called from the thread that hands in the bytes.
using SweepSink = std::function<void(LidarSweep&)>;
/// Sees the bytes of a lidar as they came, for recordings that keep them.
using BytesTap = std::function<void(std::span<const std::uint8_t> bytes, Stamp received)>;

/// What a lidar has lost since the start.
struct LidarCounters {
  std::uint64_t sweeps = 0;
  std::uint64_t lost = 0;     ///< packets or telegrams that never came
  std::uint64_t refused = 0;  ///< that came damaged, or of another device
};

/// Bytes become sweeps. No socket and no clock: drivers, the virtual factory and replays run the same one.
class LidarDecoder {
 public:
  LidarDecoder() = default;
  LidarDecoder(const LidarDecoder&) = delete;
  LidarDecoder& operator=(const LidarDecoder&) = delete;
  virtual ~LidarDecoder() = default;

  /// A packet, or any piece of a stream, that arrived at `received`.
  virtual void push(std::span<const std::uint8_t> bytes, Stamp received) = 0;
  [[nodiscard]] virtual LidarCounters counters() const = 0;
};

/// How a lidar is.
struct LidarHealth {
  Duration silence{};  ///< since the last good data; large before the first
  LidarCounters counters;
  std::string problem;  ///< what is wrong, for an operator; empty when nothing is
  std::string stop;     ///< why the vehicle must stand at once; empty when it need not
};

/// A lidar on its link, which opens itself again. Safe to ask from any thread.
class LidarDriver {
 public:
  LidarDriver() = default;
  LidarDriver(const LidarDriver&) = delete;
  LidarDriver& operator=(const LidarDriver&) = delete;
  virtual ~LidarDriver() = default;

  [[nodiscard]] virtual LidarHealth health() const = 0;
  /// Where it is listened to, for people: "UDP 2368".
  [[nodiscard]] virtual std::string place() const = 0;
  /// The port that was bound or called; 0 where there is none.
  [[nodiscard]] virtual std::uint16_t port() const { return 0; }
};

/// One lidar of a vehicle, as the site and the command line describe it.
struct LidarSettings {
  std::string name;
  std::string address;  ///< as the row's default is written; empty: the default
  LidarMounting mounting;
  std::map<std::string, std::string> values;  ///< of the row's own keys

  /// Throws Error where `values` holds a key that is not among these.
  void refuse_others(std::initializer_list<const char*> keys) const;
  /// A number among `values` within [low, high], or `otherwise`. Throws Error.
  [[nodiscard]] double number_or(const std::string& key, double otherwise, double low, double high) const;
};

struct HostAndPort {
  std::string host;
  std::uint16_t port;
};
/// "HOST:PORT", "HOST" or ":PORT"; what is missing is taken from `otherwise`. Throws Error on a port that is
/// none.
[[nodiscard]] HostAndPort host_and_port(const std::string& address, const HostAndPort& otherwise);

}  // namespace madori::sensors
