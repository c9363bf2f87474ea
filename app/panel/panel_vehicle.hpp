#pragma once

#include <memory>
#include <mutex>

#include "app/runner/transport_run.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// A running vehicle as the touch panel sees it. The cycle only copies into it (`observe`); everything the
/// panel asks is answered from that copy and from a database connection of its own.
class PanelVehicle final : public hmi::Vehicle {
 public:
  PanelVehicle(TransportRun& run, const std::filesystem::path& database);

  /// Call after every step of the cycle, on its thread.
  void observe(const CycleInput& input, const CycleState& state);

  [[nodiscard]] hmi::LiveState live() const override;
  hmi::Reply command(hmi::Command command) override;
  hmi::Reply jog(const VelocityCommand& velocity) override;
  [[nodiscard]] std::vector<hmi::OrderView> orders() const override;
  hmi::Reply add_order(const std::vector<int>& stations, int repeat) override;
  hmi::Reply cancel_order(long long id) override;
  [[nodiscard]] std::vector<hmi::EventView> events(std::size_t newest) const override;
  [[nodiscard]] hmi::StatisticsView statistics() const override;
  hmi::Reply reload_site() override;

 private:
  [[nodiscard]] Mode mode() const;
  void show_scan(const CycleInput& input, const CycleState& state);

  TransportRun& run_;
  mutable std::mutex store_mutex_;
  mutable OrderStore store_;
  mutable std::mutex mutex_;
  hmi::LiveState live_;
  Mode mode_ = Mode::Paused;
  Stamp shown_{};
};

}  // namespace madori::app
