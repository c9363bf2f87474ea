#pragma once

#include <chrono>
#include <string>

#include "mapping/drawing/read_drawing.hpp"

namespace madori::mapping {

/// Times the stages of an import and announces them.
class StageClock {
 public:
  StageClock(std::vector<StageReport>& reports, const Progress& progress)
      : reports_(reports), progress_(progress) {}

  /// `share` of the whole work is done when the stage begins.
  void begin(const std::string& name, double share) {
    if (progress_) progress_(name, share);
    name_ = name;
    start_ = std::chrono::steady_clock::now();
  }
  void end(std::size_t count) {
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start_;
    reports_.push_back({name_, spent.count(), count});
  }

 private:
  std::vector<StageReport>& reports_;
  const Progress& progress_;
  std::string name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace madori::mapping
