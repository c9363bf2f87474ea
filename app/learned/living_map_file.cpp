#include "app/learned/living_map_file.hpp"

#include <algorithm>
#include <utility>

#include "app/learned/earlier_walls.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "localization/ndt_map/hybrid_map_file.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_files.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {

using localization::CellState;
using localization::HybridMap;

namespace {

/// What is kept was seen before now. A look of a later time was stamped by a clock that was wrong; left as it
/// is, its cells would learn nothing until that time comes, and all days would be written as that day.
HybridMap seen_until(HybridMap kept, Stamp now) {
  if (kept.newest() <= now) return kept;
  HybridMap map(kept.options());
  const auto& cells = kept.cells();
  for (localization::CellTree::Index i = 0; i < cells.size(); ++i) {
    localization::MapCell cell = cells[i];
    cell.layers.seen = std::min(cell.layers.seen, now);
    map.restore(cells.place(i), cell);
  }
  return map;
}

}  // namespace

HybridMap load_living_map(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file))
    throw Error(file.string(), "there is no living map",
                "drive, or learn from a log: madori localize DIR --log LOG --learn");
  auto kept = localization::parse_hybrid_map(mapping::file_content(file));
  if (!kept.ok())
    throw Error(file.string(), "cannot be used: " + kept.reason(), "remove it; a new one is begun");
  return std::move(kept).value().map;
}

LivingMap begin_living_map(const std::filesystem::path& site, const mapping::Walls& walls) {
  const auto file = site / kLivingMapFile;
  LivingMap begun;
  if (std::filesystem::exists(file)) {
    auto kept = localization::parse_hybrid_map(mapping::file_content(file));
    std::string reason = kept.ok() ? "" : kept.reason();
    if (kept.ok() && kept.value().walls != mapping::walls_checksum(walls) &&
        !are_earlier_walls(site, kept.value().walls))
      reason = "the walls have changed since";
    if (reason.empty())
      begun.map = seen_until(std::move(kept).value().map, clock_now());
    else
      begun.message = file.string() + " is not used: " + reason + "; a new one is begun";
  }
  begun.map.draw(walls, mapping::load_other_lines(site));
  return begun;
}

void save_living_map(const std::filesystem::path& site, const HybridMap& map, const mapping::Walls& walls) {
  const auto file = site / kLivingMapFile;
  std::filesystem::create_directories(file.parent_path());
  mapping::write_file_atomically(file, localization::hybrid_map_bytes(map, mapping::walls_checksum(walls)));
}

std::vector<Point2<Map>> standing_places(const HybridMap& map) {
  std::vector<Point2<Map>> places;
  const auto& cells = map.cells();
  for (localization::CellTree::Index i = 0; i < cells.size(); ++i) {
    const CellState state = map.state(i);
    const bool stands = state == CellState::Static || state == CellState::SemiStatic;
    if (stands && !cells[i].gaussian.empty())
      places.push_back({cells[i].gaussian.x_m, cells[i].gaussian.y_m});
  }
  return places;
}

}  // namespace madori::app
