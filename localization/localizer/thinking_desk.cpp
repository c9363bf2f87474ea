#include "localization/localizer/thinking_desk.hpp"

#include <utility>

#include "core/thread_role.hpp"

namespace madori::localization {

ThinkingDesk::ThinkingDesk() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

ThinkingDesk::~ThinkingDesk() = default;

void ThinkingDesk::begin(const MapState& state, const LocalizerOptions& options) {
  state_ = state;
  options_ = options;
  {
    const std::scoped_lock lock(mutex_);
    works_ = true;
  }
  changed_.notify_all();
}

MapState& ThinkingDesk::answer() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !works_; });
  if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
  return state_;
}

void ThinkingDesk::run(const std::stop_token& stop) {
  (void)take_role("thinking", ThreadRole::Ordinary);
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return works_.load(); })) {
    lock.unlock();
    std::exception_ptr problem;
    try {
      state_.think(options_);
    } catch (...) {
      problem = std::current_exception();
    }
    lock.lock();
    problem_ = problem;
    works_ = false;
    changed_.notify_all();
  }
}

}  // namespace madori::localization
