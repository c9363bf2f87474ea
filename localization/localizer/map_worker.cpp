#include "localization/localizer/map_worker.hpp"

#include <utility>

namespace madori::localization {

void MapWorker::start(Stamp now, MapState state, const LocalizerOptions& options) {
  started_ = now;
  asked_ = 0;
  known_ = state.memory.size();
  answer_ = std::async(std::launch::async, [state = std::move(state), options]() mutable {
    state.think(options);
    return std::move(state);
  });
}

std::optional<MapState> MapWorker::take(Stamp now, const LocalizerOptions& options) {
  constexpr int kScans = 100;  // for logs whose time stands still
  const double due_s = known_ <= 1                   ? options.first_look_s
                       : known_ < options.young_size ? options.young_s
                                                     : options.thinking_s;
  if (!busy() || (to_seconds(now - started_) < due_s && ++asked_ < kScans)) {
    return std::nullopt;
  }
  return answer_.get();
}

}  // namespace madori::localization
