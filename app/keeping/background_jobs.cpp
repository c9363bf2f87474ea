#include "app/keeping/background_jobs.hpp"

#include <exception>
#include <utility>

#include "core/thread_role.hpp"

namespace madori::app {

BackgroundJobs::BackgroundJobs() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

BackgroundJobs::~BackgroundJobs() = default;

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

void BackgroundJobs::run(const std::stop_token& stop) {
  (void)take_role("keeping", ThreadRole::Behind);
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
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
