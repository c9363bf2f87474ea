#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "localization/wall_reliability/wall_reliability.hpp"
#include "localization/wall_reliability/wall_weights.hpp"

namespace madori::app {

inline constexpr const char* kReliabilityFile = "reliability.csv";

/// The drawing as driving has corrected it so far.
struct LearnedDrawing {
  localization::WallReliability reliability;  ///< of the drawn walls; nothing seen yet where nothing is kept
  localization::WallWeights drawing;          ///< what registration takes
  std::vector<std::string> messages;          ///< why something that was learned is not used
};

/// Reads `folder`/reliability.csv; without one the drawing comes out as it is.
[[nodiscard]] LearnedDrawing load_learned_drawing(const std::filesystem::path& folder,
                                                  const mapping::Walls& walls);

}  // namespace madori::app
