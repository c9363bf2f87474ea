#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include "core/odometry.hpp"
#include "core/wheels.hpp"

namespace madori::sensors {

/// Reads `time_s,left_rad,right_rad` (angles that grow on over whole turns) and reckons from it.
class WheelsCsv {
 public:
  /// Throws Error when the file cannot be opened or has another first line.
  WheelsCsv(const std::filesystem::path& file, const WheelGeometry& geometry);
  /// The pose at the next row; nothing at the end. Throws Error with file:line on a row that is damaged or
  /// goes back.
  [[nodiscard]] std::optional<OdometryReading> next();

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  WheelGeometry geometry_;
  OdometryReading reading_;
  double left_rad_ = 0.0;
  double right_rad_ = 0.0;
  int line_ = 1;
};

}  // namespace madori::sensors
