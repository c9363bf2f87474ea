#pragma once

#include <cstddef>
#include <future>
#include <optional>
#include <vector>

#include "core/stamp.hpp"
#include "localization/localizer/map_state.hpp"

namespace madori::localization {

/// Thinks a copy of the map over in a thread of its own. The answer is due by the stamps of the log; one that
/// is due is waited for, but where the owner says that it is not finished yet: on a live vehicle nothing
/// waits, and what was said is recorded. Not thread-safe itself: one owner calls it.
class MapWorker {
 public:
  [[nodiscard]] bool busy() const { return answer_.valid(); }
  /// Busy, and the thread has not come to its end. Read from outside the cycle alone: it is no input.
  [[nodiscard]] bool is_unfinished() const;
  /// Not while busy.
  void start(Stamp now, MapState state, const LocalizerOptions& options);
  /// The answer, once `now` is late enough; `unfinished`: not in this step.
  [[nodiscard]] std::optional<MapState> take(Stamp now, bool unfinished, const LocalizerOptions& options);
  /// The answer under way is not wanted any more.
  void discard();
  /// Keyframes that the map had when the work began.
  [[nodiscard]] std::size_t known() const { return known_; }

 private:
  std::future<MapState> answer_;
  std::vector<std::future<MapState>> unwanted_;  ///< that are still on their way: nobody waits for them
  Stamp started_{};
  int asked_ = 0;
  std::size_t known_ = 0;
};

}  // namespace madori::localization
