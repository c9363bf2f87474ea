#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "sensors/log_record.hpp"

namespace madori::sensors {

/// Keeps the time of a log going on where a clock was set back. One record that is late among its own kind
/// (the odometry, a scan's source) is a straggler and passes as it is; several that are late but run on among
/// themselves are of a clock that was set: these, and all that follow of this kind, are moved on by one
/// amount, so that they follow what came before. Kinds that were set together are moved by the same amount.
/// The order of the records stays. The first set is told.
class SteadyTimeReader final : public LogReader {
 public:
  SteadyTimeReader(std::unique_ptr<LogReader> source, LogRemark remark)
      : source_(std::move(source)), remark_(std::move(remark)) {}
  [[nodiscard]] std::optional<LogRecord> next() override;

 private:
  /// Late records of a kind, in the order of their coming.
  struct Doubt {
    Stamp first, last;
    int records = 1;
  };
  /// Records of one kind.
  struct Kind {
    Duration moved{};  ///< added to its stamps
    std::optional<Stamp> newest;
    std::deque<Duration> steps;  ///< between its latest records
    std::optional<Doubt> doubt;
    int sets = 0;  ///< how many of the clock's sets it has come by

    [[nodiscard]] Duration usual_step() const;
    [[nodiscard]] bool goes_on_where_moved(Duration by) const;
    void take(Stamp stamp);
  };
  /// A record that waits until it is known whether its kind's clock was set.
  struct Held {
    LogRecord record;
    Kind* doubted;  ///< whose late record it is; null: of a kind that goes on
  };

  void take(LogRecord record);
  void doubt(Kind& kind, LogRecord record);
  void believe(const Kind& set);
  void move(Kind& kind, Duration by);
  [[nodiscard]] bool in_doubt() const;

  std::unique_ptr<LogReader> source_;
  LogRemark remark_;
  std::map<std::string, Kind> kinds_;
  std::deque<Held> held_;
  int sets_ = 0;         ///< how often a clock was set back
  Duration last_set_{};  ///< by how much, the last time
  bool ended_ = false;
};

}  // namespace madori::sensors
