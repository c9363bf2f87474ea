#include "app/keeping/background_jobs.hpp"

#include <exception>
#include <utility>

#include "core/thread_role.hpp"

namespace madori::app {

BackgroundJobs::BackgroundJobs() : thread_([this] { run(); }) {}

BackgroundJobs::~BackgroundJobs() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundJobs::put(const std::string& kind, std::function<void()> job) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_[kind] = std::move(job);
  }
  changed_.notify_all();
}

void BackgroundJobs::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

std::string BackgroundJobs::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

void BackgroundJobs::run() {
  (void)take_role("keeping", ThreadRole::Behind);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto job = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    busy_ = true;
    lock.unlock();
    std::string problem;
    try {
      job();
    } catch (const std::exception& e) {
      problem = e.what();
    }
    lock.lock();
    busy_ = false;
    if (!problem.empty()) problem_ = problem;
    changed_.notify_all();
  }
}

}  // namespace madori::app
