#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/orders/order.hpp"
#include "app/orders/order_database.hpp"
#include "core/stamp.hpp"

namespace madori::app {

struct EventRecord {
  Stamp stamp{};
  std::string kind;  ///< mode, order, operator, device
  std::string text;
};

/// Orders and events of a site, madori.db (SQLite, write-ahead log, synchronous = FULL): every call that
/// returns has reached the disk, and a call that was cut off by a crash or power loss has either happened
/// wholly or not at all. Throws Error where the database cannot be used.
class OrderStore {
 public:
  explicit OrderStore(const std::filesystem::path& file);
  ~OrderStore();
  OrderStore(const OrderStore&) = delete;
  OrderStore& operator=(const OrderStore&) = delete;

  /// So many orders may wait; a queue without an end fills disk and page.
  static constexpr std::int64_t kMostOpen = 1000;

  /// Queues an order and returns its ID. Throws Error where kMostOpen are open.
  std::int64_t add(const std::vector<OrderStop>& stops, int repeat, Stamp now);
  [[nodiscard]] std::optional<Order> find(std::int64_t id) const;
  /// All orders, oldest first, or those that are running or queued, in the sequence of the queue.
  [[nodiscard]] std::vector<Order> list(bool open_only) const;
  /// Orders that are neither, the last to end first.
  [[nodiscard]] std::vector<Order> ended(std::size_t newest) const;
  /// Puts the queued orders in this sequence. False, and nothing changes, where these are not the queued
  /// ones.
  bool arrange(const std::vector<std::int64_t>& ids);
  /// Queued and running orders.
  [[nodiscard]] std::int64_t open_count() const;
  /// `nodes`: all IDs of the routes. Whatever was ordered to another one meant a station that is no more:
  /// these stops are gone, also when the number is given again, and open orders that have one before them
  /// end as Refused, with an event.
  void keep_stations(const std::vector<int>& nodes, Stamp now);
  [[nodiscard]] Stamp created(std::int64_t id) const;
  /// The running order, else the first queued one, which becomes running.
  std::optional<Order> begin_next(Stamp now);
  /// Counts stop `next_stop` of round `round` as done, once; counting it again changes nothing. The order
  /// that it completes becomes Done.
  Order stop_done(std::int64_t id, int round, std::size_t next_stop, Stamp now);
  /// Ends an open order as Cancelled or Refused.
  void close(std::int64_t id, OrderState state, const std::string& note, Stamp now);
  /// Stops counted so far, over all orders.
  [[nodiscard]] std::int64_t stops_done() const;

  /// The newest 200,000 are kept.
  void add_event(const EventRecord& event);
  [[nodiscard]] std::vector<EventRecord> events(std::size_t newest) const;
  /// What SQLite's own check says of the file: "ok" where it is intact.
  [[nodiscard]] std::string integrity() const;

 private:
  Database database_;
  std::string file_;
};

}  // namespace madori::app
