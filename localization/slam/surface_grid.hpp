#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// A map of square cells: how often each was seen as a surface and how often looked through, and the mean
/// point and direction of its surface, so that a scan is matched far finer than a cell. It lies in tiles that
/// copies share until one of them changes: many particles, one past.
class SurfaceGrid {
 public:
  static constexpr double kCellM = 0.1;

  /// A cell's surface. Map frame, metres; the normal has unit length and looks at who saw it.
  struct Surface {
    double x_m = 0.0;
    double y_m = 0.0;
    double normal_x = 0.0;
    double normal_y = 0.0;
  };
  /// What stands in a cell, as far as it was looked at.
  enum class Content { Unknown, Free, Occupied };

  /// Adds a scan seen from `pose`.
  void add(const SurfaceScan& scan, const Transform2<Map, Base>& pose);
  /// The surface nearest to `p`, at most `reach` cells away in x and y, that looks the same way as `normal`
  /// (any way where it is zero). False where there is none.
  [[nodiscard]] bool nearest(const SurfacePoint& p, int reach, Surface& found) const;
  [[nodiscard]] Content content(double x_m, double y_m) const;

 private:
  static constexpr int kTileBits = 5;
  static constexpr int kTileSide = 1 << kTileBits;
  struct Cell {
    float sum_x = 0.0F;  ///< of the points, from the tile's corner
    float sum_y = 0.0F;
    float normal_x = 0.0F;
    float normal_y = 0.0F;
    std::uint16_t hits = 0;
    std::uint16_t passes = 0;
  };
  using Tile = std::array<Cell, static_cast<std::size_t>(kTileSide) * kTileSide>;

  /// The tile looked at last: neighbours mostly lie in it.
  struct Cursor {
    std::uint64_t key = 0x8000'0000'8000'0000ULL;  // no tile's
    Tile* tile = nullptr;
  };
  [[nodiscard]] static std::size_t cell_in_tile(int ix, int iy) {
    constexpr int kMask = kTileSide - 1;
    return static_cast<std::size_t>((iy & kMask) * kTileSide + (ix & kMask));
  }
  [[nodiscard]] const Cell* look(int ix, int iy, Cursor& cursor) const;
  Cell& touch(int ix, int iy, Cursor& cursor);

  std::unordered_map<std::uint64_t, std::shared_ptr<Tile>> tiles_;
};

}  // namespace madori::localization
