#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "sensors/carmen/line.hpp"
#include "sensors/log_record.hpp"

namespace madori::sensors::carmen {

/// Reads a CARMEN text log (ODOM, FLASER, RLASER, ROBOTLASER1) in the order of its lines: a line whose time
/// lies before its forerunner's stays where it is. Stamps are the message's own time, not the logger's.
///
/// Where the laser's pose differs from the robot's by the same amount all along the log, that is the laser's
/// mounting and becomes base_from_lidar. Logs whose laser poses were corrected by a mapper have no such
/// constant.
class CarmenReader final : public LogReader {
 public:
  /// Throws Error when the file cannot be opened.
  explicit CarmenReader(const std::filesystem::path& file);
  [[nodiscard]] std::optional<LogRecord> next() override;

 private:
  std::optional<ParsedLine> next_line();
  std::optional<Transform2<Base, Lidar>> constant_offset();
  void find_mounting();

  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
  std::optional<Transform2<Base, Lidar>> mounting_;
};

}  // namespace madori::sensors::carmen
