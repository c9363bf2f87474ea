#pragma once

#include <chrono>
#include <string>

#include "mapping/drawing/read_drawing.hpp"

namespace madori::mapping {

/// Times the stages of one detection and announces them.
class StageClock {
 public:
  StageClock(DetectedWalls& found, const Progress& progress) : found_(found), progress_(progress) {}

  /// `share` of the whole work is done when the stage begins.
  void begin(const std::string& name, double share);
  void end(std::size_t count);

 private:
  DetectedWalls& found_;
  const Progress& progress_;
  std::string name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace madori::mapping
