#pragma once

#include <chrono>
#include <string>

#include "mapping/drawing/raster/detect_walls.hpp"

namespace madori::mapping {

/// Times the stages of one detection, announces them and hands out their pictures.
class StageClock {
 public:
  StageClock(DetectedWalls& found, const StageSink& sink, const Progress& progress)
      : found_(found), sink_(sink), progress_(progress) {}

  /// `share` of the whole work is done when the stage begins.
  void begin(const std::string& name, double share);
  void end(std::size_t count);
  /// Dark where `ink` is not 0; only drawn if somebody looks.
  void picture(const std::string& name, const GrayImage& ink) const;

 private:
  DetectedWalls& found_;
  const StageSink& sink_;
  const Progress& progress_;
  std::string name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace madori::mapping
