#include "app/learned/map_layers.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "app/learned/seen_box.hpp"
#include "core/result.hpp"
#include "mapping/georeference/geotiff.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::app {
namespace {

using localization::CellPlace;
using localization::CellState;
using localization::CellTree;
using localization::HybridMap;

constexpr std::uint8_t kOccupied = 0;
constexpr std::uint8_t kUnknown = 205;
constexpr std::uint8_t kFree = 254;

std::uint8_t value_of(CellState state, MapLayer layer) {
  if (state == CellState::Unseen) return kUnknown;
  if (layer == MapLayer::Static) return state == CellState::Static ? kOccupied : kFree;
  if (layer == MapLayer::SemiStatic) return state == CellState::SemiStatic ? kOccupied : kFree;
  return state == CellState::Free || state == CellState::TakenAway ? kFree : kOccupied;
}

}  // namespace

const char* to_string(MapLayer layer) {
  switch (layer) {
    case MapLayer::Static:
      return "static";
    case MapLayer::SemiStatic:
      return "semi_static";
    case MapLayer::Free:
      return "free";
  }
  return "";
}

GridMap layer_of(const HybridMap& map, MapLayer layer) {
  constexpr std::int64_t kMostPixels = 100'000'000;
  const SeenBox box = seen_box(map);
  GridMap grid;
  grid.cell_m = map.options().cell_m;
  grid.origin = {box.low.column * grid.cell_m, box.low.row * grid.cell_m};
  if (box.empty())
    throw Error("the living map", "is empty",
                "drive, or learn from a log: madori localize DIR --log LOG --learn");
  grid.width = box.width();
  grid.height = box.height();
  if (box.cells() > kMostPixels)
    throw Error("the living map", "is wider than 100 million cells",
                "the vehicle has believed wrong places: remove it");
  grid.pixels.assign(static_cast<std::size_t>(grid.width) * grid.height, kUnknown);
  const CellTree& cells = map.cells();
  for (CellTree::Index i = 0; i < cells.size(); ++i) {
    if (!cells[i].layers.was_seen()) continue;
    const CellPlace& p = cells.place(i);
    const auto row = static_cast<std::size_t>(box.high.row - p.row);
    grid.pixels[row * grid.width + (p.column - box.low.column)] = value_of(map.state(i), layer);
  }
  return grid;
}

void save_map_layers(const HybridMap& map, const std::optional<mapping::GeoreferenceRecord>& georeference,
                     const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const MapLayer layer : {MapLayer::Static, MapLayer::SemiStatic, MapLayer::Free}) {
    const GridMap grid = layer_of(map, layer);
    const auto stem = folder / to_string(layer);
    save_grid_map(stem, grid);
    const mapping::MapRaster raster{grid.cell_m, grid.origin, grid.width, grid.height, grid.pixels};
    mapping::write_file_atomically(stem.string() + ".tif", mapping::geotiff(raster, georeference));
  }
}

nlohmann::json to_json(const HybridMap& map) {
  std::array<std::size_t, 6> counts{};
  const CellTree& cells = map.cells();
  for (CellTree::Index i = 0; i < cells.size(); ++i) ++counts[static_cast<std::size_t>(map.state(i))];
  const auto count = [&](CellState state) { return counts[static_cast<std::size_t>(state)]; };
  return {{"cells", cells.size()},
          {"bytes", cells.bytes()},
          {"free", count(CellState::Free)},
          {"moving", count(CellState::Moving)},
          {"semi_static", count(CellState::SemiStatic)},
          {"static", count(CellState::Static)},
          {"taken_away", count(CellState::TakenAway)},
          {"unseen", count(CellState::Unseen)}};
}

}  // namespace madori::app
