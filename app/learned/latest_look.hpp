#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/thread_role.hpp"

namespace madori::app {

/// Hands looks to a thread that works on them behind the cycle. One that comes while it is busy takes the
/// place of the one that waits.
template <class Look>
class LatestLook {
 public:
  explicit LatestLook(std::function<void(const Look&)> work) : work_(std::move(work)) {
    thread_ = std::thread([this] { run(); });
  }
  ~LatestLook() {
    {
      const std::scoped_lock lock(mailbox_);
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
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
  void run() {
    (void)take_role("learning", ThreadRole::Behind);
    std::unique_lock lock(mailbox_);
    while (true) {
      wake_.wait(lock, [this] { return stop_ || waiting_; });
      if (stop_) return;
      const Look look = *std::exchange(waiting_, std::nullopt);
      lock.unlock();
      work_(look);
      lock.lock();
    }
  }

  std::function<void(const Look&)> work_;
  std::mutex mailbox_;
  std::condition_variable wake_;
  std::optional<Look> waiting_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace madori::app
