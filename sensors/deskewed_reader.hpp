#pragma once

#include <deque>
#include <memory>

#include "sensors/deskew.hpp"
#include "sensors/log_record.hpp"

namespace madori::sensors {

/// Moves the points of each cloud to its stamp, where the log's odometry spans the sweep. The source hands
/// out its records in the order of time, and so does this.
class DeskewedReader final : public LogReader {
 public:
  explicit DeskewedReader(std::unique_ptr<LogReader> source) : source_(std::move(source)) {}

  [[nodiscard]] std::optional<LogRecord> next() override {
    while (!ended_ && front_waits()) take();
    if (waiting_.empty()) return std::nullopt;
    LogRecord first = std::move(waiting_.front());
    waiting_.pop_front();
    if (auto* const cloud = std::get_if<CloudRecord>(&first))
      (void)deskew(cloud->cloud, cloud->base_from_lidar, track_);
    return first;
  }

 private:
  static constexpr Duration kSweep = std::chrono::milliseconds(300);  ///< longer than the slowest, of 5 Hz

  [[nodiscard]] bool front_waits() const {
    if (waiting_.empty()) return true;
    const auto* const cloud = std::get_if<CloudRecord>(&waiting_.front());
    return cloud != nullptr && stamp_of(waiting_.back()) < cloud->cloud.stamp + kSweep;
  }
  void take() {
    std::optional<LogRecord> record = source_->next();
    ended_ = !record;
    if (ended_) return;
    if (const auto* const reading = std::get_if<OdometryReading>(&*record)) track_.add(*reading);
    waiting_.push_back(std::move(*record));
  }

  std::unique_ptr<LogReader> source_;
  std::deque<LogRecord> waiting_;
  OdometryTrack track_;
  bool ended_ = false;
};

}  // namespace madori::sensors
