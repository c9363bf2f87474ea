#pragma once

#include <string>
#include <vector>

#include "mapping/georeference/tile_store.hpp"

namespace madori::mapping {

/// The saved tiles side by side (missing ones grey), north up, with the attribution and a scale bar. PNG
/// bytes. Throws Error when none of the tiles is there.
[[nodiscard]] std::string mosaic_png(const TileStore& store, const std::vector<TileId>& tiles);

}  // namespace madori::mapping
