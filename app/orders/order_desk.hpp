#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/orders/order_store.hpp"

namespace madori::app {

/// The cycle's place at madori.db: which order is to be worked on, stops that were reached, events. Another
/// thread reads and writes, so that a slow, full, locked or missing disk holds no step up; what was reported
/// is tried until it is written, and the order changes when it is. Until then the vehicle goes on with the
/// order that it has, and begins no other. The reporting members are the cycle's.
class OrderDesk {
 public:
  struct Options {
    bool lock_step = false;  ///< reads and writes within the call: runs that have to be the same every time
    double poll_s = 0.5;     ///< how often new and cancelled orders are looked for
  };

  /// `stations`: all IDs of the routes, for OrderStore::keep_stations(), where they are known. Throws Error
  /// where the database cannot be used.
  OrderDesk(const std::filesystem::path& database, const Options& options,
            const std::optional<std::vector<int>>& stations = std::nullopt);
  /// Writes what is left.
  ~OrderDesk();
  OrderDesk(const OrderDesk&) = delete;
  OrderDesk& operator=(const OrderDesk&) = delete;

  /// The order as it stood in the database lately. `may_begin`: the next one of the queue may begin, once
  /// what became of the one before was given here.
  [[nodiscard]] std::optional<Order> order(Stamp now, bool may_begin);
  void stop_reached(const Target& stop, Stamp label);
  /// The order ends at once.
  void refuse(std::int64_t id, const std::string& why, Stamp label);
  /// What runs in the database ends at once, also an order that was not given here yet; none begins before
  /// that is written.
  void cancel_running(const std::string& why, Stamp label);
  void add(EventRecord event);
  /// Why orders cannot be read or written; empty while they can.
  [[nodiscard]] std::string problem() const;

 private:
  struct Report {
    Target what;
    std::optional<std::string> ended;  ///< why; nothing: the stop was reached
    Stamp label{};
    OrderState state = OrderState::Refused;  ///< of what ended; Cancelled: whatever runs
  };
  struct Work {
    std::deque<Report> reports;
    std::deque<EventRecord> events;
    bool fresh = false;  ///< there is a report that was not tried yet
    bool look = false, may_begin = false;
    Stamp label{};
  };

  void report(Report report);
  void run(const std::stop_token& stop);
  void do_work(std::unique_lock<std::mutex>& lock);
  [[nodiscard]] std::optional<Order> settle(const Report& report);
  [[nodiscard]] std::optional<Order> look(const std::optional<Order>& known, const Work& work);
  void write(const std::deque<EventRecord>& events);
  void tell(const std::string& problem);

  Options options_;
  OrderStore store_;  ///< of the thread that works
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  Work waiting_;
  std::optional<Order> order_;
  std::string problem_;
  Stamp asked_{};
  bool seen_ = true;  ///< the cycle was given what its last report led to
  std::jthread thread_;
};

}  // namespace madori::app
