#pragma once

#include <map>
#include <memory>

#include "sensors/log_record.hpp"

namespace madori::sensors {

/// Sorts records by their stamps, as far as they are out of order by less than `window`.
class TimeOrderedReader final : public LogReader {
 public:
  TimeOrderedReader(std::unique_ptr<LogReader> source, Duration window)
      : source_(std::move(source)), window_(window) {}

  [[nodiscard]] std::optional<LogRecord> next() override {
    while (!ended_ && (waiting_.empty() || waiting_.rbegin()->first - waiting_.begin()->first < window_)) {
      std::optional<LogRecord> record = source_->next();
      if (!record) {
        ended_ = true;
        break;
      }
      const Stamp stamp = stamp_of(*record);
      waiting_.emplace(stamp, std::move(*record));
    }
    if (waiting_.empty()) return std::nullopt;
    LogRecord first = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    return first;
  }

 private:
  std::unique_ptr<LogReader> source_;
  Duration window_;
  std::multimap<Stamp, LogRecord> waiting_;
  bool ended_ = false;
};

}  // namespace madori::sensors
