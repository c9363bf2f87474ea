#include "localization/localizer/map_worker.hpp"

#include <algorithm>
#include <utility>

namespace madori::localization {

void MapWorker::discard() {
  if (busy_) unwanted_.push_back(std::move(desk_));
  busy_ = false;
}

std::unique_ptr<ThinkingDesk> MapWorker::free_desk() {
  const auto free = std::ranges::find_if(unwanted_, [](const auto& desk) { return !desk->works(); });
  if (free == unwanted_.end()) return std::make_unique<ThinkingDesk>();
  auto desk = std::move(*free);
  unwanted_.erase(free);
  return desk;
}

void MapWorker::start(Stamp now, const MapState& state, const LocalizerOptions& options) {
  started_ = now;
  asked_ = 0;
  known_ = state.memory.size();
  if (!desk_) desk_ = free_desk();
  desk_->begin(state, options);
  busy_ = true;
}

MapState* MapWorker::take(Stamp now, bool unfinished, const LocalizerOptions& options) {
  constexpr int kScans = 100;  // for logs whose time stands still
  const double due_s = known_ <= 1                   ? options.first_look_s
                       : known_ < options.young_size ? options.young_s
                                                     : options.thinking_s;
  const bool is_due = busy_ && (to_seconds(now - started_) >= due_s || ++asked_ >= kScans);
  if (!is_due || unfinished) return nullptr;
  busy_ = false;
  return &desk_->answer();
}

}  // namespace madori::localization
