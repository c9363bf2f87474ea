#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "localization/ndt_map/cell_gaussian.hpp"
#include "localization/ndt_map/cell_layers.hpp"

namespace madori::localization {

/// Column and row of a cell; cell (0, 0) has its lower-left corner at the frame's origin.
struct CellPlace {
  std::int32_t column = 0;
  std::int32_t row = 0;
  friend bool operator==(const CellPlace&, const CellPlace&) = default;
};

struct MapCell {
  CellGaussian gaussian;  ///< of what is seen; of other days little is left
  CellLayers layers;
  CellGaussian lasting;  ///< of what is known to be permanent, which may be hidden or gone
  std::array<std::int32_t, 2> drawn{-1, -1};  ///< lines nearest to its middle, walls first, which have faces
  float clear_above_m = std::numeric_limits<float>::infinity();  ///< lowest beam through it; not kept
};

/// Cells in a quadtree of fixed depth; a cell exists once it was asked for with at(). Indices stay as they
/// are.
class CellTree {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = std::numeric_limits<Index>::max();
  static constexpr int kDepth = 16;
  static constexpr std::int32_t kHalf = 1 << (kDepth - 1);

  [[nodiscard]] static bool holds(const CellPlace& p) {
    return p.column >= -kHalf && p.column < kHalf && p.row >= -kHalf && p.row < kHalf;
  }
  /// kNone where there is none. Precondition of both: holds(place).
  [[nodiscard]] Index find(const CellPlace& place) const;
  Index at(const CellPlace& place);

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] MapCell& operator[](Index i) { return cells_[i]; }
  [[nodiscard]] const MapCell& operator[](Index i) const { return cells_[i]; }
  [[nodiscard]] const CellPlace& place(Index i) const { return places_[i]; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  using Branch = std::array<Index, 4>;
  static constexpr Branch kEmpty{kNone, kNone, kNone, kNone};
  static constexpr int kBlockLevel = 3;  ///< blocks of 8 x 8 cells
  [[nodiscard]] static std::size_t child(const CellPlace& place, int level);
  Index descend(Index node, std::size_t quarter);

  std::vector<Branch> branches_{kEmpty};  ///< the first is the root; the lowest ones hold cells
  std::vector<MapCell> cells_;
  std::vector<CellPlace> places_;
  CellPlace block_;  ///< that of the last cell asked for with at() ...
  Index block_branch_ = kNone;
};

}  // namespace madori::localization
