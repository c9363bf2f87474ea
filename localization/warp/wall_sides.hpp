#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// The drawn walls as surfaces of a memory may belong to them: which walls are near, and from which side each
/// can be seen.
class WallSides {
 public:
  static constexpr double kReachM = 1.2;  ///< a surface farther from a wall's line does not belong to it

  /// A wall that a surface may belong to.
  struct Candidate {
    std::size_t wall = 0;
    int side = 0;             ///< 0 where the surface is seen from the left of a -> b
    double distance_m = 0.0;  ///< from the wall's line, along the left normal
    double along_m = 0.0;     ///< of the foot from a, within the wall
    double odds = 1.0;        ///< 0..1, by direction and by the side that can be seen
  };
  struct Line {
    Point2<Map> a;
    double ux = 1.0;  ///< along
    double uy = 0.0;
    double length_m = 0.0;
    double open[2] = {1.0, 1.0};  ///< by side: 1 where it can be seen, near 0 where the wall's other face is
  };

  explicit WallSides(const mapping::Walls& walls);

  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }
  [[nodiscard]] const Point2<Map>& low() const { return low_; }
  [[nodiscard]] const Point2<Map>& high() const { return high_; }
  [[nodiscard]] Point2<Map> foot(std::size_t wall, double along_m) const {
    const Line& line = lines_[wall];
    return {line.a.x_m + along_m * line.ux, line.a.y_m + along_m * line.uy};
  }

  /// Calls visit(candidate) for each wall near `p` that runs as a surface with this unit normal, which looks
  /// at the sensor.
  template <class Visit>
  void for_each_near(const Point2<Map>& p, double normal_x, double normal_y, Visit&& visit) const {
    const std::size_t cell = cell_of(p);
    if (cell == kNoCell) return;
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
      Candidate found;
      found.wall = walls_[k];
      if (belongs(p, normal_x, normal_y, found)) visit(found);
    }
  }

 private:
  static constexpr std::size_t kNoCell = static_cast<std::size_t>(-1);
  static constexpr double kCellM = 1.0;

  [[nodiscard]] std::size_t cell_of(const Point2<Map>& p) const;
  [[nodiscard]] bool belongs(const Point2<Map>& p, double nx, double ny, Candidate& found) const;
  void hash();
  void find_faces(const mapping::Walls& walls);

  std::vector<Line> lines_;
  Point2<Map> low_;
  Point2<Map> high_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< cells + 1 entries into walls_
  std::vector<std::uint32_t> walls_;
};

}  // namespace madori::localization
