#include "app/learned/learned_drawing.hpp"

#include "localization/wall_reliability/reliability_file.hpp"

namespace madori::app {

LearnedDrawing load_learned_drawing(const std::filesystem::path& folder, const mapping::Walls& walls) {
  const auto file = folder / kReliabilityFile;
  if (!std::filesystem::exists(file)) return {{walls, std::vector<double>(walls.size(), 1.0)}, {}};
  localization::WallReliability reliability(walls);
  LearnedDrawing learned;
  const std::string message = localization::load_reliability(file, reliability);
  if (!message.empty()) learned.messages.push_back(message);
  learned.drawing = localization::wall_weights(walls, reliability);
  return learned;
}

}  // namespace madori::app
