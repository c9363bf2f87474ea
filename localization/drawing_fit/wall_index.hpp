#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "localization/drawing_fit/visible_faces.hpp"
#include "mapping/wall_map/grid_frame.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// The nearest drawn wall that runs as a seen surface does and can be seen from where it was seen: furniture
/// beside a wall, or the wall across a corner, seldom runs the way the surface runs, and the far face of a
/// wall is seen by nobody. One table of nearest walls a direction, walls within 30 degrees in each.
class WallIndex {
 public:
  static constexpr double kRadiusM = 1.5;  ///< farther from every wall, a surface belongs to none
  static constexpr int kDirections = 16;   ///< of the normals of surfaces, over a whole turn

  struct Hit {
    int wall = -1;            ///< position in the walls given, -1 for none
    double distance_m = 0.0;  ///< to the wall's line, signed along the normal
    double normal_x = 0.0;
    double normal_y = 0.0;
    double along_m = 0.0;      ///< from the wall's start; may lie beyond its ends
    double beyond_m = 0.0;     ///< how far beyond its ends, 0 beside the wall
    double probability = 0.0;  ///< that it is a wall at all, as the drawing has it
  };

  explicit WallIndex(const mapping::Walls& walls) : WallIndex(walls, visible_faces(walls)) {}
  /// Where it is known from which sides each can be seen.
  WallIndex(const mapping::Walls& walls, const std::vector<VisibleFace>& faces);

  [[nodiscard]] const mapping::Walls& walls() const { return walls_; }
  /// The table of a surface with this normal, which looks at the sensor.
  [[nodiscard]] static int direction_of(double normal_x, double normal_y);
  [[nodiscard]] Hit nearest(double x_m, double y_m, int direction) const;
  /// Of whatever direction.
  [[nodiscard]] Hit nearest(double x_m, double y_m) const;
  /// Distance to the nearest wall of the direction, centimetres, 255 for none within the radius.
  [[nodiscard]] std::uint8_t centimetres(double x_m, double y_m, int direction) const {
    const std::int64_t cell = frame_.find({x_m, y_m});
    return cell < 0
               ? kFar
               : tables_[static_cast<std::size_t>(direction)].centimetres[static_cast<std::size_t>(cell)];
  }

 private:
  static constexpr std::uint8_t kFar = 255;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Table {
    std::vector<std::uint32_t> line;  ///< twice the position in lines_[side], plus the side
    std::vector<std::uint8_t> centimetres;
  };
  /// What nearest() asks of a stretch of a wall that can be seen from a side.
  struct Line {
    int wall = -1;
    Point2<Map> from;                     ///< where the wall begins
    double along_x = 0.0, along_y = 0.0;  ///< unit vector
    SeenStretch seen;
    double probability = 0.0;
  };
  void add_lines(int wall, const VisibleFace& face);
  void fill(int direction);

  mapping::Walls walls_;
  std::array<std::vector<Line>, 2> lines_;  ///< seen from the left of a wall, and from its right
  mapping::GridFrame frame_;
  std::array<Table, kDirections> tables_;
};

}  // namespace madori::localization
