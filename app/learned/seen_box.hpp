#pragma once

#include "localization/ndt_map/hybrid_map.hpp"

namespace madori::app {

/// Lowest and highest column and row of what was seen of a map; empty where nothing was.
struct SeenBox {
  localization::CellPlace low{0, 0}, high{-1, -1};

  [[nodiscard]] bool empty() const { return high.column < low.column; }
  [[nodiscard]] int width() const { return high.column - low.column + 1; }
  [[nodiscard]] int height() const { return high.row - low.row + 1; }
  [[nodiscard]] std::int64_t cells() const { return std::int64_t{width()} * height(); }
};
[[nodiscard]] SeenBox seen_box(const localization::HybridMap& map);

}  // namespace madori::app
