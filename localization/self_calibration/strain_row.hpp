#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/transform2.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/self_calibration/surface_pieces.hpp"

namespace madori::localization {

/// A strain x, y, shear (rad) of the true-to-scale plane about a point, and what it makes of a place.
struct StrainAbout {
  Point2<Map> middle;
  Eigen::Vector3d strain = Eigen::Vector3d::Zero();
  [[nodiscard]] Point2<Map> drawn(const Point2<Map>& true_place) const;
};

/// A piece beside the drawn wall nearest to it: how far off, and the slopes of that in pose and strain.
struct StrainRow {
  int keyframe = 0;
  int wall = 0;
  double residual_m = 0.0;
  double weight = 0.0;  ///< robust, 1 / m^2
  Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_strain = Eigen::Vector3d::Zero();
};

/// The piece seen from `pose` (true-to-scale plane); nothing where no wall of its direction lies within
/// `beside_m`. `wall` is the position in the drawing, residual positive along the wall's normal; keyframe and
/// weight are left to the caller.
[[nodiscard]] std::optional<StrainRow> strain_row(const WallIndex& drawing, const StrainAbout& strained,
                                                  const Transform2<Map, Base>& pose,
                                                  const SurfacePiece& piece, double beside_m);

/// Weight 1 at no residual, falling to 0 beyond some `scale`.
[[nodiscard]] double geman_mcclure(double residual, double scale);

}  // namespace madori::localization
