#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/orders/order_store.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// The order queue as the panel sees and changes it, on a database connection of its own: the cycle finds
/// there what has changed. All members may be called from any thread.
class PanelOrders {
 public:
  /// `node_name` tells the name of a node that an order may name; nothing for others.
  using NodeName = std::function<std::optional<std::string>(int id)>;
  PanelOrders(const std::filesystem::path& database, NodeName node_name);

  [[nodiscard]] std::vector<hmi::OrderView> open() const;
  [[nodiscard]] std::vector<hmi::OrderView> ended() const;
  /// Where an order has no stop, or too many; looked at before anything that takes longer the more there are.
  [[nodiscard]] static std::optional<hmi::Reply> wrong_count(const std::vector<hmi::StopView>& stops);
  hmi::Reply add(const std::vector<hmi::StopView>& stops, int repeat);
  [[nodiscard]] std::optional<hmi::OrderView> find(long long id) const;
  hmi::Reply cancel(long long id);
  hmi::Reply arrange(const std::vector<long long>& ids);
  /// As OrderStore::keep_stations(), by the routes of `site` as they are saved now; nothing happens while
  /// these cannot be read.
  void keep_stations(const std::filesystem::path& site);
  [[nodiscard]] static hmi::Reply unknown_order();
  /// An operator's word, among the events.
  void tell(const std::string& text);
  [[nodiscard]] std::vector<hmi::EventView> events(std::size_t newest) const;
  [[nodiscard]] long long stops_done() const;

 private:
  [[nodiscard]] hmi::OrderView view(const Order& order) const;

  NodeName node_name_;
  mutable std::mutex mutex_;
  OrderStore store_;
};

}  // namespace madori::app
