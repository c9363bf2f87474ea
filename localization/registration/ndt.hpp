#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "localization/registration/point_map.hpp"
#include "localization/registration/registration_result.hpp"
#include "localization/scan_points.hpp"
#include "mapping/wall_map/grid_frame.hpp"

namespace madori::localization {

/// The map as normal distributions: each cell holds mean and covariance of its points; four grids, shifted by
/// half a cell, overlap (Biber and Strasser, The Normal Distributions Transform, IROS 2003, sections III and
/// IV). Three sizes of cells, from coarse to fine. On mathematically flat walls the smaller eigenvalue is
/// raised to a twentieth of the larger.
class NdtMap {
 public:
  explicit NdtMap(std::span<const Point2<Map>> points, std::array<double, 3> cells_m = {3.0, 1.5, 0.75});

  struct Cell {
    double mean_x = 0.0, mean_y = 0.0;
    double a = 0.0, b = 0.0, c = 0.0;  ///< of the inverse covariance (a b; b c)
    bool used = false;
  };
  static constexpr int kLevels = 3;
  /// Cell of grid 0..3 of a level that holds (x, y); nullptr where none has enough points.
  [[nodiscard]] const Cell* find(int level, int grid, double x_m, double y_m) const;
  [[nodiscard]] const PointMap& points() const { return points_; }

 private:
  struct Grid {
    mapping::GridFrame frame;
    std::vector<Cell> cells;
  };
  PointMap points_;
  std::array<std::array<Grid, 4>, kLevels> grids_;
};

struct NdtOptions {
  int max_iterations = 30;  ///< a level
  double step_limit_m = 1e-4;
  double step_limit_rad = 1e-5;
};

/// The score of the NDT, level by level (Biber and Strasser, section V), by Gauss-Newton steps: Newton's own
/// Hessian is indefinite where the exponentials bend down, a few decimetres off, and leads away from there.
[[nodiscard]] RegistrationResult ndt(const ScanPoints& points, const NdtMap& map,
                                     const Transform2<Map, Base>& initial, const NdtOptions& options = {});

}  // namespace madori::localization
