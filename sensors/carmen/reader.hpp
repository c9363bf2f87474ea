#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "sensors/carmen/line.hpp"
#include "sensors/log_record.hpp"

namespace madori::sensors::carmen {

/// Reads a CARMEN text log (ODOM, FLASER, RLASER, ROBOTLASER1; RAWLASER1 where there is none of these) in the
/// order of its lines: a line whose time lies before its forerunner's stays where it is. Stamps are the
/// message's own time, not the logger's.
///
/// Where a laser's pose differs from the robot's by the same amount until the robot has driven and turned,
/// that is this laser's mounting and becomes base_from_lidar. Logs whose laser poses were corrected by a
/// mapper have no such constant.
class CarmenReader final : public LogReader {
 public:
  /// Throws Error when the file cannot be opened.
  explicit CarmenReader(const std::filesystem::path& file);
  [[nodiscard]] std::optional<LogRecord> next() override;

 private:
  std::optional<ParsedLine> next_line();
  void note_skipped();
  void find_mountings();

  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
  LogParams params_;
  std::map<std::string, Transform2<Base, Lidar>> mountings_;  ///< by source
  std::set<std::string> skipped_;                             ///< kinds of messages
  bool raw_only_ = true;                                      ///< no line tells of a scan and its pose
  bool any_scan_ = false;
};

}  // namespace madori::sensors::carmen
