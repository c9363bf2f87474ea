#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "app/braking/braking_desk.hpp"
#include "app/camera/camera_capture.hpp"
#include "app/panel/jog_holds.hpp"
#include "app/panel/live_copy.hpp"
#include "app/panel/panel_orders.hpp"
#include "app/runner/site_run.hpp"
#include "app/runner/socket_link.hpp"
#include "app/statistics/work_meter.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// A vehicle as the touch panel sees it, from an empty site on. The cycle only copies into it (`observe`,
/// `idle`); everything the panel asks is answered from that copy and from a database connection of its own.
class PanelVehicle final : public hmi::Vehicle {
 public:
  /// `camera`: a source of CameraCapture; empty for none.
  PanelVehicle(SiteRun& run, const std::filesystem::path& database, SocketOptions devices,
               const std::string& camera = "");

  /// On the cycle's thread: a run begins; after each of its steps; after a tick without a run.
  void begin_run();
  void observe(const CycleInput& input, const CycleState& state, const TransportRun& run);
  void idle(const CycleInput& input);

  [[nodiscard]] hmi::LiveState live() const override;
  hmi::Reply command(hmi::Command command) override;
  hmi::Reply jog(const VelocityCommand& velocity, const void* who) override;
  void jog_silent(const void* who) override;
  [[nodiscard]] std::vector<hmi::OrderView> orders() const override { return orders_.open(); }
  [[nodiscard]] std::vector<hmi::OrderView> order_history() const override { return orders_.ended(); }
  hmi::Reply add_order(const std::vector<hmi::StopView>& stops, int repeat) override;
  hmi::Reply repeat_order(long long id) override;
  hmi::Reply cancel_order(long long id) override { return orders_.cancel(id); }
  hmi::Reply arrange_orders(const std::vector<long long>& ids) override { return orders_.arrange(ids); }
  [[nodiscard]] hmi::LocateView locate() const override { return copy_.locate(); }
  hmi::Reply search_place() override;
  hmi::Reply set_pose(const Transform2<Map, Base>& map_from_base) override;
  hmi::Reply insist_on_pose(const Transform2<Map, Base>& map_from_base) override;
  hmi::Reply report(const std::string& text) override;
  hmi::Reply start_braking_test(bool loaded) override;
  [[nodiscard]] hmi::BrakingView braking() const override;
  [[nodiscard]] std::vector<hmi::FoundDevice> found_devices() const override;
  [[nodiscard]] std::vector<hmi::FoundDevice> search_devices() const override;
  [[nodiscard]] std::vector<hmi::LidarView> lidar_views() const override;
  hmi::Reply measure_mounting() override;
  hmi::Reply stop_measuring() override;
  [[nodiscard]] hmi::MountingState mounting() const override;
  [[nodiscard]] std::vector<hmi::EventView> events(std::size_t newest) const override;
  [[nodiscard]] hmi::StatisticsView statistics() const override;
  [[nodiscard]] std::vector<hmi::WallView> walls_seen() const override;
  [[nodiscard]] std::shared_ptr<const std::string> camera_jpeg() const override;
  [[nodiscard]] hmi::MappingView mapping() const override;
  [[nodiscard]] std::shared_ptr<const std::string> mapping_points() const override;
  [[nodiscard]] std::vector<hmi::FoundDevice> lidar_kinds() const override;
  hmi::Reply start_mapping(const mapping::VehicleRecord& vehicle,
                           const std::vector<mapping::SensorRecord>& sensors, bool anew) override;
  hmi::Reply drop_mapping() override;
  [[nodiscard]] hmi::Reply may_finish_mapping() const override;
  std::size_t finish_mapping(
      const std::function<void(const std::string& stage, double share)>& progress) override;
  [[nodiscard]] std::vector<planning::DrivenPose> driven_way() const override;
  [[nodiscard]] hmi::Reply may_change_site() const override;
  void reload_site() override;

 private:
  void note_way_by_hand(const CycleState& state, const CycleConfig& config);
  [[nodiscard]] hmi::Reply not_drivable() const;
  [[nodiscard]] bool is_measuring() const;
  [[nodiscard]] std::optional<hmi::Reply> still_loads() const;
  /// Why nobody may drive by hand now.
  [[nodiscard]] std::optional<hmi::Reply> no_jog(const std::optional<VehicleView>& view) const;
  /// Why it does not stand: it drives, or a measurement or a braking test has it, between its ways too.
  [[nodiscard]] std::optional<hmi::Reply> moves() const;
  /// Refused while it moves(), or while something is to be confirmed that a new run would forget.
  [[nodiscard]] hmi::Reply may_begin_anew() const;

  SiteRun& run_;
  std::filesystem::path site_;
  SocketOptions devices_;
  LiveCopy copy_;
  PanelOrders orders_;
  WorkMeter meter_;
  JogHolds jogging_;
  BrakingDesk braking_;
  std::optional<CameraCapture> camera_;
  std::mutex begins_;                      ///< two panels at once: one of them begins what moves the vehicle
  std::atomic<bool> finishing_ = false;    ///< a site is being made of the map
  mutable std::mutex way_mutex_;           ///< of what follows
  std::vector<planning::DrivenPose> way_;  ///< driven by hand since that began last
  bool by_hand_ = false;
  // of the ticks' thread
  std::vector<mapping::SensorRecord> idle_sensors_;
  std::vector<LidarModel> idle_lidars_;
};

}  // namespace madori::app
