#pragma once

#include <deque>
#include <memory>

#include "core/scan_as_cloud.hpp"
#include "sensors/deskew.hpp"
#include "sensors/log_record.hpp"

namespace madori::sensors {

/// Moves the points of each cloud, and of each scan whose beams have a period, to its stamp, where the log's
/// odometry spans the sweep. The source hands out its records in the order of time, and so does this.
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
    else if (takes_time(first))
      deskew_scan(std::get<ScanRecord>(first));
    return first;
  }

 private:
  static constexpr Duration kSweep = std::chrono::milliseconds(300);  ///< longer than the slowest, of 5 Hz

  /// A scan that claims to take longer than any lidar does states the period of something else.
  [[nodiscard]] static bool takes_time(const LogRecord& record) {
    if (std::holds_alternative<CloudRecord>(record)) return true;
    const auto* const scan = std::get_if<ScanRecord>(&record);
    if (scan == nullptr || scan->scan.beam_period <= Duration(0)) return false;
    return to_seconds(scan->scan.beam_period) * static_cast<double>(scan->scan.ranges_m.size()) <=
           to_seconds(kSweep);
  }
  [[nodiscard]] bool front_waits() const {
    if (waiting_.empty()) return true;
    const LogRecord& front = waiting_.front();
    return takes_time(front) && stamp_of(waiting_.back()) < stamp_of(front) + kSweep;
  }
  void deskew_scan(ScanRecord& record) const {
    PointCloud<Lidar> sweep;
    scan_as_cloud(record.scan, sweep);
    if (deskew(sweep, record.base_from_lidar, track_)) record.moved = std::move(sweep);
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
