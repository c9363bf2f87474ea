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

/// The child of a branch, made where there is none.
CellTree::Index CellTree::descend(Index node, std::size_t quarter) {
  if (branches_[node][quarter] == kNone) {
    branches_[node][quarter] = static_cast<Index>(branches_.size());
    branches_.push_back(kEmpty);
  }
  return branches_[node][quarter];
}

/// A beam goes from a cell to the next: the way down to a block of cells is remembered.
CellTree::Index CellTree::at(const CellPlace& place) {
  const CellPlace block{place.column >> kBlockLevel, place.row >> kBlockLevel};
  if (!(block == block_) || block_branch_ == kNone) {
    Index node = 0;
    for (int level = kDepth; level > kBlockLevel; --level) node = descend(node, child(place, level));
    block_ = block;
    block_branch_ = node;
  }
  Index node = block_branch_;
  for (int level = kBlockLevel; level > 1; --level) node = descend(node, child(place, level));
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
