#pragma once

#include <deque>
#include <mutex>

#include "app/runner/transport_run.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// What the panel shows of the running cycle. The cycle only copies into it, at most ten times a second.
class LiveCopy {
 public:
  /// On the cycle's thread, after every step.
  void show(const CycleInput& input, const CycleState& state, const TransportRun& run);
  /// On the same thread while the site cannot be driven yet: what the devices say.
  void show_setup(const CycleInput& input, const std::string& problem);
  /// The vehicle's odometer, metres; added to what is shown.
  void set_odometer(double metres);

  // From any thread:
  [[nodiscard]] hmi::LiveState live() const;
  [[nodiscard]] hmi::LocateView locate() const;
  [[nodiscard]] Mode mode() const;
  [[nodiscard]] bool hears_lidar() const;

 private:
  [[nodiscard]] bool due(Stamp now);
  void count_revolutions(const CycleInput& input);
  void enter(const std::string& state, Stamp now);
  void take_scan(const CycleInput& input, const planning::SensorView& lidar, double yaw_rad,
                 const Transform2<Map, Base>& pose);
  void take_devices(Stamp now, const std::optional<Stamp>& lidar, const std::optional<Stamp>& drive,
                    const std::string& problem);
  void take_places(const CycleState& state, Stamp now);

  mutable std::mutex mutex_;
  hmi::LiveState live_;
  hmi::LocateView locate_;
  Mode mode_ = Mode::Paused;
  Stamp shown_{};
  Stamp placed_{};
  Stamp scanned_{};
  std::deque<Stamp> revolutions_;  ///< of the last second
  std::deque<Stamp> reports_;      ///< of the drive, of the last second
};

}  // namespace madori::app
