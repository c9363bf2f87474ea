#pragma once

#include <cstddef>
#include <future>
#include <optional>

#include "core/stamp.hpp"
#include "localization/localizer/map_state.hpp"

namespace madori::localization {

/// Thinks a copy of the map over in a thread of its own. When the answer is taken in is decided by the stamps
/// of the log alone: on a live vehicle the thread has long finished by then, in a quick replay it is waited
/// for. Not thread-safe itself: one owner calls it.
class MapWorker {
 public:
  [[nodiscard]] bool busy() const { return answer_.valid(); }
  /// Not while busy.
  void start(Stamp now, MapState state, const LocalizerOptions& options);
  /// The answer, once `now` is late enough.
  [[nodiscard]] std::optional<MapState> take(Stamp now, const LocalizerOptions& options);
  /// The answer under way is not wanted any more.
  void discard() {
    if (busy()) unwanted_ = std::move(answer_);  // waits for one that was unwanted before
  }
  /// Keyframes that the map had when the work began.
  [[nodiscard]] std::size_t known() const { return known_; }

 private:
  std::future<MapState> answer_;
  std::future<MapState> unwanted_;
  Stamp started_{};
  int asked_ = 0;
  std::size_t known_ = 0;
};

}  // namespace madori::localization
