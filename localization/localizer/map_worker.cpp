#include "localization/localizer/map_worker.hpp"

#include <chrono>
#include <utility>

#include "core/thread_role.hpp"

namespace madori::localization {
namespace {

bool has_ended(const std::future<MapState>& answer) {
  return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

bool MapWorker::is_unfinished() const {
  return busy() && !has_ended(answer_);
}

void MapWorker::discard() {
  std::erase_if(unwanted_, has_ended);
  if (busy()) unwanted_.push_back(std::move(answer_));
}

void MapWorker::start(Stamp now, MapState state, const LocalizerOptions& options) {
  started_ = now;
  asked_ = 0;
  known_ = state.memory.size();
  answer_ = std::async(std::launch::async, [state = std::move(state), options]() mutable {
    (void)take_role("thinking", ThreadRole::Ordinary);
    state.think(options);
    return std::move(state);
  });
}

std::optional<MapState> MapWorker::take(Stamp now, bool unfinished, const LocalizerOptions& options) {
  constexpr int kScans = 100;  // for logs whose time stands still
  const double due_s = known_ <= 1                   ? options.first_look_s
                       : known_ < options.young_size ? options.young_s
                                                     : options.thinking_s;
  const bool is_due = busy() && (to_seconds(now - started_) >= due_s || ++asked_ >= kScans);
  if (!is_due || unfinished) return std::nullopt;
  return answer_.get();
}

}  // namespace madori::localization
