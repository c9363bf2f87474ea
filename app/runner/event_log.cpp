#include "app/runner/event_log.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/thread_role.hpp"

namespace madori::app {

EventLog::EventLog(const std::filesystem::path& database) : store_(database), thread_([this] { run(); }) {}

EventLog::~EventLog() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void EventLog::add(EventRecord event) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(std::move(event));
  }
  wake_.notify_one();
}

void EventLog::run() {
  (void)take_role("event log", ThreadRole::Behind);
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto batch = std::exchange(waiting_, {});
    lock.unlock();
    for (const EventRecord& event : batch) {
      try {
        store_.add_event(event);
      } catch (const std::exception& e) {
        spdlog::error("event lost: {} ({})", event.text, e.what());
      }
    }
    lock.lock();
  }
}

}  // namespace madori::app
