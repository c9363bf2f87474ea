#pragma once

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "sensors/carmen/reader.hpp"

namespace madori::test {

/// A log of which only every n-th scan arrives; the wheels are all there.
inline std::vector<sensors::LogRecord> records_of(const std::filesystem::path& file, int every = 1) {
  sensors::carmen::CarmenReader log(file);
  std::vector<sensors::LogRecord> all;
  for (int scans = 0; auto record = log.next();) {
    const auto* scan = std::get_if<sensors::ScanRecord>(&*record);
    if (scan == nullptr || scans++ % every == 0) {
      all.push_back(std::move(*record));
    } else if (scan->odom_from_base) {
      all.emplace_back(OdometryReading{scan->scan.stamp, *scan->odom_from_base});
    }
  }
  return all;
}

/// A log cut into pieces that are joined in another order: at every joint the vehicle is carried to another
/// place, and neither wheels nor stamps tell of it.
class CutLog final : public sensors::LogReader {
 public:
  /// Carried away `times` times; pieces of at least half their mean length, by number of records.
  CutLog(std::vector<sensors::LogRecord> records, std::size_t times, unsigned seed) {
    std::mt19937 engine(seed);
    const std::size_t pieces = times + 1;
    std::vector<std::size_t> bounds{0};
    for (std::size_t i = 1; i < pieces; ++i) {
      std::uniform_real_distribution<double> off(-0.25, 0.25);
      bounds.push_back(static_cast<std::size_t>((static_cast<double>(i) + off(engine)) *
                                                static_cast<double>(records.size()) /
                                                static_cast<double>(pieces)));
    }
    bounds.push_back(records.size());
    std::vector<std::size_t> order(pieces);
    std::iota(order.begin(), order.end(), std::size_t{0});
    do {
      std::shuffle(order.begin(), order.end(), engine);
    } while (any_followed(order));
    for (const std::size_t piece : order) {
      starts_.push_back(records_.size());
      append(records, bounds[piece], bounds[piece + 1]);
    }
  }

  std::optional<sensors::LogRecord> next() override {
    if (next_ == records_.size()) return std::nullopt;
    return records_[next_++];
  }
  /// When the record of a stamp of this log was recorded.
  [[nodiscard]] Stamp recorded(Stamp stamp) const {
    const auto at = std::lower_bound(stamps_.begin(), stamps_.end(), std::pair{stamp, Stamp{}});
    return at == stamps_.end() ? stamps_.back().second : at->second;
  }
  /// The first record of each piece.
  [[nodiscard]] const std::vector<std::size_t>& starts() const { return starts_; }
  [[nodiscard]] const std::vector<sensors::LogRecord>& records() const { return records_; }

 private:
  static bool any_followed(const std::vector<std::size_t>& order) {
    for (std::size_t i = 1; i < order.size(); ++i)
      if (order[i] == order[i - 1] + 1) return true;
    return false;
  }
  static std::optional<Transform2<Odom, Base>> wheels_of(const sensors::LogRecord& record) {
    if (const auto* odometry = std::get_if<OdometryReading>(&record)) return odometry->odom_from_base;
    if (const auto* scan = std::get_if<sensors::ScanRecord>(&record)) return scan->odom_from_base;
    return std::nullopt;
  }

  void append(const std::vector<sensors::LogRecord>& records, std::size_t begin, std::size_t end) {
    std::optional<Transform2<Odom, Odom>> by;
    const Duration shift = records_.empty()
                               ? -sensors::stamp_of(records[begin]).time_since_epoch()
                               : sensors::stamp_of(records_.back()) + std::chrono::milliseconds(200) -
                                     sensors::stamp_of(records[begin]);
    for (std::size_t i = begin; i < end; ++i) {
      sensors::LogRecord record = records[i];
      const Stamp was = sensors::stamp_of(record);
      if (const auto wheels = wheels_of(record); wheels && !by) {
        const auto last = newest_wheels();
        by = last ? *last * wheels->inverse() : Transform2<Odom, Odom>();
      }
      if (auto* odometry = std::get_if<OdometryReading>(&record)) {
        odometry->stamp += shift;
        odometry->odom_from_base = *by * odometry->odom_from_base;
      } else if (auto* scan = std::get_if<sensors::ScanRecord>(&record)) {
        scan->scan.stamp += shift;
        if (scan->odom_from_base) scan->odom_from_base = *by * *scan->odom_from_base;
      }
      stamps_.emplace_back(was + shift, was);
      records_.push_back(std::move(record));
    }
    std::sort(stamps_.begin(), stamps_.end());
  }
  [[nodiscard]] std::optional<Transform2<Odom, Base>> newest_wheels() const {
    for (auto r = records_.rbegin(); r != records_.rend(); ++r)
      if (const auto wheels = wheels_of(*r)) return wheels;
    return std::nullopt;
  }

  std::vector<sensors::LogRecord> records_;
  std::vector<std::pair<Stamp, Stamp>> stamps_;  ///< as played, as recorded; ascending
  std::vector<std::size_t> starts_;
  std::size_t next_ = 0;
};

}  // namespace madori::test
