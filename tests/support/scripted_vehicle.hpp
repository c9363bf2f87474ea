#pragma once

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

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
  hmi::Reply jog(const VelocityCommand& velocity) override {
    const std::scoped_lock lock(mutex_);
    jogs_.push_back(velocity);
    return hmi::Reply::done();
  }
  [[nodiscard]] std::vector<hmi::OrderView> orders() const override {
    const std::scoped_lock lock(mutex_);
    return orders_;
  }
  hmi::Reply add_order(const std::vector<int>& stations, int repeat) override {
    const std::scoped_lock lock(mutex_);
    if (stations.empty()) return hmi::Reply::refused("empty-order", "an order needs a station");
    hmi::OrderView order;
    order.id = ++last_id_;
    order.stations = stations;
    order.repeat = repeat;
    order.status = "queued";
    orders_.push_back(order);
    return hmi::Reply::done();
  }
  hmi::Reply cancel_order(long long id) override {
    const std::scoped_lock lock(mutex_);
    const auto removed = std::erase_if(orders_, [id](const auto& o) { return o.id == id; });
    return removed == 1 ? hmi::Reply::done() : hmi::Reply::refused("no-order", "there is no such order");
  }
  [[nodiscard]] std::vector<hmi::EventView> events(std::size_t) const override { return {}; }
  [[nodiscard]] hmi::StatisticsView statistics() const override { return {3}; }
  hmi::Reply reload_site() override {
    const std::scoped_lock lock(mutex_);
    ++reloads_;
    return hmi::Reply::done();
  }

  void show(hmi::LiveState live) {
    const std::scoped_lock lock(mutex_);
    live_ = std::move(live);
  }
  void refuse_start() {
    const std::scoped_lock lock(mutex_);
    refuse_start_ = true;
  }
  [[nodiscard]] std::vector<VelocityCommand> jogs() const {
    const std::scoped_lock lock(mutex_);
    return jogs_;
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
  bool refuse_start_ = false;
};

}  // namespace madori::test
