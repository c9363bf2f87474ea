#pragma once

#include <array>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::planning {

/// The shortest way from pose to pose that drives forward only and turns no sharper than a radius: three
/// pieces, each an arc to the left, straight on, or an arc to the right (Shkel and Lumelsky, Classification
/// of the Dubins set, Robotics and Autonomous Systems 34, 2001).
struct DubinsCurve {
  struct Piece {
    double turn = 0.0;    ///< 1 to the left, 0 straight on, -1 to the right
    double length = 0.0;  ///< in turning radii; of an arc its angle
  };

  Transform2<Map, Base> start;
  double radius_m = 1.0;
  std::array<Piece, 3> pieces;

  [[nodiscard]] double length_m() const {
    return radius_m * (pieces[0].length + pieces[1].length + pieces[2].length);
  }
  /// `along_m` from the start, beyond the end: the end.
  [[nodiscard]] Transform2<Map, Base> pose_at(double along_m) const;
};

/// Precondition: both poses finite, `radius_m` positive. OMPL's own DubinsStateSpace ends the program where a
/// heading lies within 5e-7 rad of straight on (an assertion that Debian's build keeps), so it is not used.
[[nodiscard]] DubinsCurve shortest_dubins(const Transform2<Map, Base>& from, const Transform2<Map, Base>& to,
                                          double radius_m);

}  // namespace madori::planning
