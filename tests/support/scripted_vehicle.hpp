#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hmi/server/job.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::test {

/// A vehicle for tests of the panel's server: it does what it is told and remembers it.
class ScriptedVehicle : public hmi::Vehicle {
 public:
  [[nodiscard]] hmi::LiveState live() const override {
    const std::scoped_lock lock(mutex_);
    return live_;
  }
  hmi::Reply command(hmi::Command command) override {
    const std::scoped_lock lock(mutex_);
    commands_.push_back(command);
    if (command == hmi::Command::Start && refuse_start_)
      return hmi::Reply::refused("lost", "the vehicle does not know where it is");
    return hmi::Reply::done();
  }
  hmi::Reply jog(const VelocityCommand& velocity, const void* /*who*/) override {
    const std::scoped_lock lock(mutex_);
    jogs_.push_back(velocity);
    return hmi::Reply::done();
  }
  void jog_silent(const void* /*who*/) override {
    const std::scoped_lock lock(mutex_);
    jogs_.emplace_back();
    ++silences_;
  }
  [[nodiscard]] std::vector<hmi::OrderView> orders() const override {
    const std::scoped_lock lock(mutex_);
    return orders_;
  }
  [[nodiscard]] std::vector<hmi::OrderView> order_history() const override { return {}; }
  hmi::Reply add_order(const std::vector<hmi::StopView>& stops, int repeat) override {
    const std::scoped_lock lock(mutex_);
    if (stops.empty()) return hmi::Reply::refused("empty-order", "an order needs a station");
    hmi::OrderView order;
    order.id = ++last_id_;
    order.stops = stops;
    order.repeat = repeat;
    order.status = "queued";
    orders_.push_back(order);
    return hmi::Reply::done();
  }
  hmi::Reply repeat_order(long long id) override {
    const auto known = orders();
    for (const auto& order : known)
      if (order.id == id) return add_order(order.stops, order.repeat);
    return hmi::Reply::refused("no-order", "there is no such order");
  }
  hmi::Reply arrange_orders(const std::vector<long long>& ids) override {
    const std::scoped_lock lock(mutex_);
    std::vector<hmi::OrderView> arranged;
    for (const long long id : ids)
      for (const auto& order : orders_)
        if (order.id == id) arranged.push_back(order);
    if (arranged.size() != orders_.size()) return hmi::Reply::refused("conflict", "the queue has changed");
    orders_ = arranged;
    return hmi::Reply::done();
  }
  hmi::Reply cancel_order(long long id) override {
    const std::scoped_lock lock(mutex_);
    const auto removed = std::erase_if(orders_, [id](const auto& o) { return o.id == id; });
    return removed == 1 ? hmi::Reply::done() : hmi::Reply::refused("no-order", "there is no such order");
  }
  [[nodiscard]] hmi::LocateView locate() const override { return {"ambiguous", {{{1.0, 2.0, 0.5}, 0.8}}}; }
  hmi::Reply search_place() override { return hmi::Reply::done(); }
  hmi::Reply set_pose(const Transform2<Map, Base>& map_from_base) override {
    const std::scoped_lock lock(mutex_);
    poses_.push_back(map_from_base);
    return hmi::Reply::done();
  }
  [[nodiscard]] std::vector<hmi::FoundDevice> found_devices() const override {
    return {{"vlp16",
             "VLP-16",
             "UDP 2368",
             true,
             {"heard", {}, "heard"},
             mapping::SensorRecord{"top", "vlp16", 0.3, 0.0, 1.2, 0.0}}};
  }
  [[nodiscard]] std::vector<hmi::EventView> events(std::size_t) const override { return {}; }
  [[nodiscard]] hmi::StatisticsView statistics() const override {
    return {3, 120.5, 100.0, 20.0, std::nullopt, {{{"paused", {}, "paused"}, 2, 20.0}}};
  }
  [[nodiscard]] std::shared_ptr<const std::string> camera_jpeg() const override { return camera_; }
  [[nodiscard]] hmi::Reply may_change_site() const override {
    const std::scoped_lock lock(mutex_);
    return driving_ || (drives_when_ && drives_when_())
               ? hmi::Reply::refused("driving", "the vehicle is driving: pause it first")
               : hmi::Reply::done();
  }
  void reload_site() override {
    const std::scoped_lock lock(mutex_);
    ++reloads_;
  }

  [[nodiscard]] hmi::MappingView mapping() const override {
    const std::scoped_lock lock(mutex_);
    hmi::MappingView view;
    view.state = mapping_;
    view.walls = {{{0.0, 0.0}, {4.0, 0.0}}};
    view.sensors = mapping_sensors_;
    return view;
  }
  [[nodiscard]] std::shared_ptr<const std::string> mapping_points() const override {
    const std::scoped_lock lock(mutex_);
    return mapping_ == "mapping" ? std::make_shared<const std::string>("MDS2") : nullptr;
  }
  [[nodiscard]] std::vector<hmi::FoundDevice> lidar_kinds() const override {
    return {
        {"vlp16", "VLP-16", "2368", false, {}, mapping::SensorRecord{"top", "vlp16", 0.3, 0.0, 1.2, 0.0}}};
  }
  hmi::Reply start_mapping(const mapping::VehicleRecord& vehicle,
                           const std::vector<mapping::SensorRecord>& sensors, bool /*anew*/) override {
    const std::scoped_lock lock(mutex_);
    mapping_ = "mapping";
    mapping_sensors_ = sensors;
    mapping_length_m_ = vehicle.length_m;
    return hmi::Reply::done();
  }
  hmi::Reply drop_mapping() override {
    const std::scoped_lock lock(mutex_);
    mapping_ = "none";
    return hmi::Reply::done();
  }
  [[nodiscard]] hmi::Reply may_finish_mapping() const override {
    const std::scoped_lock lock(mutex_);
    return mapping_ == "mapping" ? hmi::Reply::done()
                                 : hmi::Reply::refused("not-mapping", "no map is being made by driving");
  }
  std::size_t finish_mapping(const std::function<void(const std::string&, double)>& progress) override {
    progress("last-look", 0.1);
    if (driven_.empty()) throw hmi::Job::Failed("mapping-too-short", "too little was driven");
    return 4;
  }
  [[nodiscard]] std::vector<planning::DrivenPose> driven_way() const override { return driven_; }

  [[nodiscard]] std::vector<hmi::WallView> walls_seen() const override {
    const std::scoped_lock lock(mutex_);
    return walls_;
  }

  void see_walls(std::vector<hmi::WallView> walls) {
    const std::scoped_lock lock(mutex_);
    walls_ = std::move(walls);
  }
  void drive_way(std::vector<planning::DrivenPose> way) { driven_ = std::move(way); }
  [[nodiscard]] double mapping_length_m() const {
    const std::scoped_lock lock(mutex_);
    return mapping_length_m_;
  }
  void drive(bool driving) {
    const std::scoped_lock lock(mutex_);
    driving_ = driving;
  }
  /// It drives off by itself.
  void drive_when(std::function<bool()> when) {
    const std::scoped_lock lock(mutex_);
    drives_when_ = std::move(when);
  }
  void show_camera(std::string jpeg) { camera_ = std::make_shared<const std::string>(std::move(jpeg)); }
  [[nodiscard]] std::vector<Transform2<Map, Base>> poses() const {
    const std::scoped_lock lock(mutex_);
    return poses_;
  }
  void show(hmi::LiveState live) {
    const std::scoped_lock lock(mutex_);
    live_ = std::move(live);
  }
  /// What it was told so far.
  void forget() {
    const std::scoped_lock lock(mutex_);
    jogs_.clear();
    poses_.clear();
    commands_.clear();
    orders_.clear();
  }
  void refuse_start() {
    const std::scoped_lock lock(mutex_);
    refuse_start_ = true;
  }
  [[nodiscard]] std::vector<VelocityCommand> jogs() const {
    const std::scoped_lock lock(mutex_);
    return jogs_;
  }
  /// How often a panel that held a jog button fell silent.
  [[nodiscard]] int silences() const {
    const std::scoped_lock lock(mutex_);
    return silences_;
  }
  [[nodiscard]] std::vector<hmi::Command> commands() const {
    const std::scoped_lock lock(mutex_);
    return commands_;
  }
  [[nodiscard]] int reloads() const {
    const std::scoped_lock lock(mutex_);
    return reloads_;
  }

 private:
  mutable std::mutex mutex_;
  hmi::LiveState live_;
  std::vector<hmi::OrderView> orders_;
  std::vector<VelocityCommand> jogs_;
  std::vector<hmi::Command> commands_;
  long long last_id_ = 0;
  int reloads_ = 0;
  int silences_ = 0;
  bool driving_ = false;
  std::function<bool()> drives_when_;
  std::vector<Transform2<Map, Base>> poses_;
  std::shared_ptr<const std::string> camera_;
  bool refuse_start_ = false;
  std::string mapping_ = "none";
  std::vector<mapping::SensorRecord> mapping_sensors_;
  double mapping_length_m_ = 0.0;
  std::vector<planning::DrivenPose> driven_;
  std::vector<hmi::WallView> walls_;
};

}  // namespace madori::test
