#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// Window of a correlative search around a predicted pose, and how dear leaving the prediction is.
struct SearchWindow {
  double half_m = 0.4;
  double half_rad = 0.3;
  double sigma_m = 0.2;    ///< of the prediction
  double sigma_rad = 0.1;  ///< of the prediction
};

/// The best pose on the grid and its score.
struct SearchResult {
  Transform2<Map, Base> map_from_base;
  double score = 0.0;  ///< mean likelihood of the points, 0..1, less the penalty of leaving the prediction
};

/// Smeared occupancy of a piece of the map and its maxima over growing windows, for an exhaustive search by
/// branch and bound (Olson 2009; Hess et al. 2016, Real-Time Loop Closure in 2D LIDAR SLAM).
class ScoreGrid {
 public:
  static constexpr double kResolutionM = 0.05;
  static constexpr int kLevels = 4;  ///< windows of 1, 2, 4, 8 cells

  /// A point of the map and its weight, 0..1.
  struct Mark {
    Point2<Map> point;
    double weight = 1.0;
  };
  ScoreGrid() = default;
  explicit ScoreGrid(const std::vector<Mark>& marks) { build(marks); }
  /// Of other marks, in the same memory.
  void build(const std::vector<Mark>& marks);

  [[nodiscard]] SearchResult search(const SurfaceScan& scan, const Transform2<Map, Base>& prediction,
                                    const SearchWindow& window) const;

 private:
  using Level = std::vector<std::uint8_t>;
  void smear(const std::vector<Mark>& marks);
  void pool(int level);
  [[nodiscard]] std::uint8_t at(int level, int x, int y) const {
    if (static_cast<unsigned>(x) >= static_cast<unsigned>(width_) ||
        static_cast<unsigned>(y) >= static_cast<unsigned>(height_)) {
      return 0;
    }
    return levels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(y) * width_ + x];
  }

  int width_ = 0;
  int height_ = 0;
  Point2<Map> origin_;
  std::array<Level, kLevels> levels_;
  Level row_;  ///< room for pool()
  /// Room that one search after the other works in.
  struct Rotation {
    double offset_rad = 0.0;
    std::size_t first_inside = 0;  ///< of its cells
    std::size_t first_outside = 0;
  };
  struct Candidate {
    std::size_t rotation;
    int x;
    int y;
    double bound;
    std::size_t order;  ///< as they were found: of equal bounds the first is looked at first
  };
  struct SearchRoom {
    std::vector<double> ranges;
    std::vector<Rotation> rotations;
    /// Cells of the scan's points, rotation after rotation: those that stay within the grid wherever the
    /// window puts them, by their index, and the others.
    std::vector<int> inside;
    std::vector<std::array<int, 2>> outside;
    std::vector<Candidate> top;
  };
  mutable SearchRoom room_;

  friend class BranchAndBound;
};

}  // namespace madori::localization
