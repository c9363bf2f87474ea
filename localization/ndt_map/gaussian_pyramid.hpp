#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "localization/ndt_map/cell_gaussian.hpp"
#include "localization/ndt_map/cell_tree.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

class HybridMap;

/// The Gaussians of one size of cells.
class GaussianLevel {
 public:
  explicit GaussianLevel(double cell_m = 1.0) : cell_m_(cell_m) {}

  /// Into the cell that holds its mean, merged with what is there.
  void add(const CellGaussian& gaussian);
  [[nodiscard]] const CellGaussian* find(const CellPlace& place) const;
  [[nodiscard]] CellPlace place_of(double x_m, double y_m) const;
  [[nodiscard]] const std::vector<CellGaussian>& cells() const { return cells_; }
  [[nodiscard]] double cell_m() const { return cell_m_; }

 private:
  double cell_m_;
  std::vector<CellGaussian> cells_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

/// What stands somewhere as Gaussians, in cells of four sizes, each twice as large as the one before. A
/// coarser Gaussian has the moments of those below it. The frame is the caller's.
class GaussianPyramid {
 public:
  static constexpr std::size_t kLevels = 4;

  explicit GaussianPyramid(double cell_m = 0.25);
  /// One end point a point.
  GaussianPyramid(const ScanPoints& points, double cell_m);
  /// Occupied places of a map; each counts the same, however often it is named.
  GaussianPyramid(std::span<const Point2<Map>> occupied, double cell_m);
  /// What stands: static and semi-static cells.
  explicit GaussianPyramid(const HybridMap& map);

  /// Level 0 is the finest.
  [[nodiscard]] const GaussianLevel& level(std::size_t i) const { return levels_[i]; }
  [[nodiscard]] bool empty() const { return levels_[0].cells().empty(); }

 private:
  void fill_coarser();
  std::array<GaussianLevel, kLevels> levels_;
};

}  // namespace madori::localization
