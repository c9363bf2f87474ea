#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/thread_role.hpp"

namespace madori::app {

/// Hands looks to a thread that works on them behind the cycle. One that comes while it is busy takes the
/// place of the one that waits.
template <class Look>
class LatestLook {
 public:
  explicit LatestLook(std::function<void(const Look&)> work)
      : work_(std::move(work)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
  LatestLook(const LatestLook&) = delete;
  LatestLook& operator=(const LatestLook&) = delete;

  void hand(Look look) {
    {
      const std::scoped_lock lock(mailbox_);
      waiting_ = std::move(look);
    }
    wake_.notify_one();
  }

 private:
  void run(const std::stop_token& stop) {
    (void)take_role("learning", ThreadRole::Behind);
    std::unique_lock lock(mailbox_);
    while (wake_.wait(lock, stop, [this] { return waiting_.has_value(); }) && !stop.stop_requested()) {
      const Look look = *std::exchange(waiting_, std::nullopt);
      lock.unlock();
      work_(look);
      lock.lock();
    }
  }

  std::function<void(const Look&)> work_;
  std::mutex mailbox_;
  std::condition_variable_any wake_;
  std::optional<Look> waiting_;
  std::jthread thread_;
};

}  // namespace madori::app
