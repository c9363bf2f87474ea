#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

#include "localization/localizer/map_state.hpp"

namespace madori::localization {

/// A copy of a map, and a thread of its own that thinks it over when asked. Both are there from the first to
/// the last question: asking starts no thread, and what lay on the desk before makes room for the next copy.
/// One owner calls it.
class ThinkingDesk {
 public:
  ThinkingDesk();
  ThinkingDesk(const ThinkingDesk&) = delete;
  ThinkingDesk& operator=(const ThinkingDesk&) = delete;
  /// Waits for what is under way.
  ~ThinkingDesk();

  /// Not while it works.
  void begin(const MapState& state, const LocalizerOptions& options);
  [[nodiscard]] bool works() const { return works_; }
  /// Waits, and gives what was thought out, for the caller to take; throws what the thinking threw.
  [[nodiscard]] MapState& answer();

 private:
  void run(const std::stop_token& stop);

  MapState state_;
  LocalizerOptions options_;
  std::exception_ptr problem_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::atomic<bool> works_ = false;  ///< set by the owner, taken back by the thread
  std::jthread thread_;
};

}  // namespace madori::localization
