#pragma once

#include <cmath>
#include <vector>

#include "core/angle.hpp"
#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::test {

/// What lays the first poses' positions on those of the second, least squares: a map has no place of its own,
/// and noise in its first scans turns all of it.
inline Transform2<Map, Map> laid_on(const std::vector<Transform2<Map, Base>>& from,
                                    const std::vector<Transform2<Map, Base>>& to) {
  const auto n = static_cast<double>(from.size());
  double ax = 0.0, ay = 0.0, bx = 0.0, by = 0.0, dot = 0.0, cross = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    ax += from[i].x_m() / n, ay += from[i].y_m() / n;
    bx += to[i].x_m() / n, by += to[i].y_m() / n;
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double px = from[i].x_m() - ax, py = from[i].y_m() - ay;
    const double qx = to[i].x_m() - bx, qy = to[i].y_m() - by;
    dot += px * qx + py * qy;
    cross += px * qy - py * qx;
  }
  const Transform2<Map, Map> turn(0.0, 0.0, std::atan2(cross, dot));
  const Point2<Map> turned = turn * Point2<Map>{ax, ay};
  return {bx - turned.x_m, by - turned.y_m, turn.yaw_rad()};
}

}  // namespace madori::test
