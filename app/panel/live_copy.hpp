#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "app/cycle/notice.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// What the panel shows of the running cycle. The cycle only copies into it, at most ten times a second.
class LiveCopy {
 public:
  /// On the cycle's thread, after every step.
  void show(const CycleInput& input, const CycleState& state, const CycleConfig& config,
            const std::string& device_problem);
  /// On the same thread while the site cannot be driven yet: what the devices say. `sensors` as they are
  /// open.
  void show_setup(const CycleInput& input, const std::vector<LidarModel>& lidars, const std::string& problem);
  /// The same while a measurement of the mountings drives the vehicle.
  void show_measuring(const CycleInput& input, const std::vector<LidarModel>& lidars,
                      const std::string& problem);
  /// The vehicle's odometer, metres; added to what is shown.
  void set_odometer(double metres);

  // From any thread:
  [[nodiscard]] hmi::LiveState live() const;
  [[nodiscard]] hmi::LocateView locate() const;
  [[nodiscard]] Mode mode() const;
  /// What each lidar saw last, Base frame, at most 400 points, and its sweeps in the last second.
  struct Look {
    std::vector<Point2<Base>> points;
    double rate_hz = 0.0;
  };
  [[nodiscard]] Look look(std::size_t lidar) const;

 private:
  [[nodiscard]] bool due(Stamp now);
  bool show_without_run(const CycleInput& input, const std::vector<LidarModel>& lidars,
                        const std::string& problem, const CatalogueEntry& cause,
                        const CatalogueEntry& remedy);
  void count_revolutions(const CycleInput& input);
  void enter(const std::string& state, Stamp now);
  void take_scan(const CycleInput& input, const std::vector<LidarModel>& lidars,
                 const Transform2<Map, Base>& pose);
  void take_devices(Stamp now, const std::vector<LidarModel>& lidars, const std::optional<Stamp>& drive,
                    const std::string& problem);
  void take_places(const CycleState& state, Stamp now);

  mutable std::mutex mutex_;
  hmi::LiveState live_;
  hmi::LocateView locate_;
  Mode mode_ = Mode::Paused;
  Stamp shown_{};
  Stamp placed_{};
  Stamp scanned_{};
  Stamp counted_{};                                                          ///< the newest step
  std::map<std::size_t, std::deque<Stamp>> revolutions_;                     ///< by lidar, of the last second
  std::map<std::size_t, Stamp> heard_;                                       ///< by lidar
  std::map<std::size_t, std::pair<Stamp, std::vector<Point2<Base>>>> seen_;  ///< by lidar, the newest sweep
  std::deque<Stamp> reports_;  ///< of the drive, of the last second
};

}  // namespace madori::app
