#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <thread>

#include "app/orders/order_store.hpp"

namespace madori::app {

/// Writes events to madori.db from a thread of its own, so that the cycle never waits for the disk while
/// driving.
class EventLog {
 public:
  explicit EventLog(const std::filesystem::path& database);
  /// Writes what is left.
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  void add(EventRecord event);

 private:
  void run();

  OrderStore store_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<EventRecord> waiting_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace madori::app
