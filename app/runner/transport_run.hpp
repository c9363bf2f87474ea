#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "app/orders/order_desk.hpp"
#include "app/runner/vehicle_link.hpp"
#include "planning/detour/detour_planner.hpp"

namespace madori::app {

/// What others may see of a running vehicle.
struct VehicleView {
  Stamp now{};
  Mode mode = Mode::Paused;
  Standstill standstill;
  PoseEstimate pose;
  std::optional<Order> order;
  VelocityCommand command;
  double cross_track_m = 0.0;
  double battery_v = 0.0;
  std::string device_problem;
  control::wire::Status drive;  ///< newest
};

struct TransportOptions {
  std::filesystem::path site;
  /// Lock-step runs: what a live run does beside its steps (detours, localization's thinking, orders) is
  /// waited for, and bounded by work instead of time.
  bool lock_step = false;
  double store_poll_s = 0.5;  ///< how often new and cancelled orders are looked for
};

/// Ties the pure cycle to the world: collects its input, carries out its output, keeps orders and events.
class TransportRun {
 public:
  using Tap = std::function<void(const CycleInput&, const CycleOutput&, const CycleState&)>;

  TransportRun(CycleConfig config, std::unique_ptr<PoseSource> source, std::unique_ptr<VehicleLink> link,
               const TransportOptions& options);

  /// One step of the cycle at `now`. Call every 20 ms.
  void tick(Stamp now);
  /// An event that did not come from the cycle, to log and panel. From the ticks' thread.
  void tell(const std::string& text);
  /// From any thread.
  void say(const OperatorCommand& command);
  [[nodiscard]] VehicleView view() const;
  /// Sees every step: recordings.
  void set_tap(Tap tap) { tap_ = std::move(tap); }
  [[nodiscard]] const CycleState& state() const { return state_; }
  [[nodiscard]] const CycleConfig& config() const { return config_; }

 private:
  void carry_out(const CycleOutput& output, Stamp moment);
  void ask_detour(const planning::DetourRequest& request);
  void tell_trouble(const std::string& text, Stamp now);

  CycleConfig config_;
  TransportOptions options_;
  std::unique_ptr<VehicleLink> link_;
  OrderDesk orders_;
  planning::DetourOptions detour_options_;
  std::unique_ptr<planning::DetourPlanner> planner_;
  std::optional<planning::DetourAnswer> answer_;
  CycleState state_;
  Tap tap_;
  std::map<std::string, Stamp> troubles_;  ///< of devices, told, and when they were there last
  mutable std::mutex mutex_;
  std::vector<OperatorCommand> said_;
  VehicleView view_;
};

}  // namespace madori::app
