#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/stamp.hpp"
#include "localization/localizer/thinking_desk.hpp"

namespace madori::localization {

/// Thinks a copy of the map over in a thread of its own. The answer is due by the stamps of the log; one that
/// is due is waited for, but where the owner says that it is not finished yet: on a live vehicle nothing
/// waits, and what was said is recorded. Not thread-safe itself: one owner calls it.
class MapWorker {
 public:
  [[nodiscard]] bool busy() const { return busy_; }
  /// Busy, and the thread has not come to its end. Read from outside the cycle alone: it is no input.
  [[nodiscard]] bool is_unfinished() const { return busy_ && desk_->works(); }
  /// Not while busy.
  void start(Stamp now, const MapState& state, const LocalizerOptions& options);
  /// The answer, for the caller to change places with, once `now` is late enough; null before.
  /// `unfinished`: not in this step.
  [[nodiscard]] MapState* take(Stamp now, bool unfinished, const LocalizerOptions& options);
  /// The answer under way is not wanted any more.
  void discard();
  /// Keyframes that the map had when the work began.
  [[nodiscard]] std::size_t known() const { return known_; }

 private:
  [[nodiscard]] std::unique_ptr<ThinkingDesk> free_desk();

  std::unique_ptr<ThinkingDesk> desk_;                   ///< from the first start on
  std::vector<std::unique_ptr<ThinkingDesk>> unwanted_;  ///< nobody waits for what they still think over
  bool busy_ = false;
  Stamp started_{};
  int asked_ = 0;
  std::size_t known_ = 0;
};

}  // namespace madori::localization
