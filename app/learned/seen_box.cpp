#include "app/learned/seen_box.hpp"

#include <algorithm>

namespace madori::app {

using localization::CellPlace;
using localization::CellTree;

SeenBox seen_box(const localization::HybridMap& map) {
  SeenBox box;
  const CellTree& cells = map.cells();
  for (CellTree::Index i = 0; i < cells.size(); ++i) {
    if (!cells[i].layers.was_seen()) continue;
    const CellPlace& p = cells.place(i);
    if (box.empty()) box = {p, p};
    box.low = {std::min(box.low.column, p.column), std::min(box.low.row, p.row)};
    box.high = {std::max(box.high.column, p.column), std::max(box.high.row, p.row)};
  }
  return box;
}

}  // namespace madori::app
