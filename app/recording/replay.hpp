#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "app/cycle/cycle.hpp"

namespace madori::app {

/// What came of running the cycle on a recording.
struct ReplayResult {
  std::uint64_t steps = 0;
  std::uint64_t different = 0;  ///< steps whose command was not the recorded one, bit for bit
  std::int64_t first_different = -1;
  double recorded_s = 0.0;  ///< of vehicle time
  double worked_s = 0.0;    ///< of computing, reading the bags not counted
  bool recorded_poses =
      false;  ///< the run's beginning is missing: localization as recorded, all else computed
};

/// Runs the cycle on the bags of a recorded run in order, `source` made as it was for the run. Where bags are
/// missing, at the beginning or in the middle (what is kept of a stop), the cycle begins with what it
/// remembered then, and its poses are those of the recording. Throws Error where a bag is missing, damaged,
/// or no recording of Madori.
[[nodiscard]] ReplayResult replay(const std::filesystem::path& run, const CycleConfig& config,
                                  std::unique_ptr<PoseSource> source);

using InputLook = std::function<void(const CycleInput&)>;
/// Hands out what reached the cycle in each step of a recorded run; `config` needs the lidars alone. Throws
/// Error as replay() does.
void look_at_inputs(const std::filesystem::path& run, const CycleConfig& config, const InputLook& look);

}  // namespace madori::app
