#include "app/learned/learned_drawing.hpp"

#include "localization/wall_reliability/reliability_file.hpp"

namespace madori::app {

LearnedDrawing load_learned_drawing(const std::filesystem::path& folder, const mapping::Walls& walls) {
  const auto file = folder / kReliabilityFile;
  LearnedDrawing learned{
      localization::WallReliability(walls), {walls, std::vector<double>(walls.size(), 1.0)}, {}};
  if (!std::filesystem::exists(file)) return learned;
  const std::string message = localization::load_reliability(file, learned.reliability);
  if (!message.empty()) learned.messages.push_back(message);
  learned.drawing = localization::wall_weights(walls, learned.reliability);
  return learned;
}

}  // namespace madori::app
