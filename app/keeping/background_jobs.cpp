#include "app/keeping/background_jobs.hpp"

#include <exception>
#include <utility>

#include "core/failure_words.hpp"
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
  return problems_.empty() ? "" : problems_.begin()->second;
}

void BackgroundJobs::run(const std::stop_token& stop) {
  (void)take_role("keeping", ThreadRole::Behind);
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    const auto taken = waiting_.extract(waiting_.begin());
    busy_ = true;
    lock.unlock();
    std::string problem;
    try {
      taken.mapped()();
    } catch (const std::exception& e) {
      problem = failure_words(e);
    }
    lock.lock();
    busy_ = false;
    if (problem.empty())
      problems_.erase(taken.key());
    else
      problems_[taken.key()] = problem;
    changed_.notify_all();
  }
}

}  // namespace madori::app
