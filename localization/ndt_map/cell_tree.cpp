#include "localization/ndt_map/cell_tree.hpp"

namespace madori::localization {

/// Which quarter of the node at `level` above the cells holds the place.
std::size_t CellTree::child(const CellPlace& place, int level) {
  const auto u = static_cast<std::uint32_t>(place.column + kHalf);
  const auto v = static_cast<std::uint32_t>(place.row + kHalf);
  return ((u >> (level - 1)) & 1U) | (((v >> (level - 1)) & 1U) << 1U);
}

CellTree::Index CellTree::find(const CellPlace& place) const {
  Index node = 0;
  for (int level = kDepth; level > 0 && node != kNone; --level) node = branches_[node][child(place, level)];
  return node;
}

CellTree::Index CellTree::at(const CellPlace& place) {
  Index node = 0;
  for (int level = kDepth; level > 1; --level) {
    const std::size_t quarter = child(place, level);
    if (branches_[node][quarter] == kNone) {
      branches_[node][quarter] = static_cast<Index>(branches_.size());
      branches_.push_back(kEmpty);
    }
    node = branches_[node][quarter];
  }
  Index& cell = branches_[node][child(place, 1)];
  if (cell == kNone) {
    cell = static_cast<Index>(cells_.size());
    cells_.emplace_back();
    places_.push_back(place);
  }
  return cell;
}

std::size_t CellTree::bytes() const {
  return branches_.size() * sizeof(Branch) + cells_.size() * (sizeof(MapCell) + sizeof(CellPlace));
}

}  // namespace madori::localization
