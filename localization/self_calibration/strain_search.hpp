#pragma once

#include <vector>

#include "localization/self_calibration/self_calibration.hpp"
#include "localization/self_calibration/strain_row.hpp"

namespace madori::localization {

/// A strain at which the drawing suits the scans better than at those around it.
struct StrainPeak {
  Eigen::Vector3d strain = Eigen::Vector3d::Zero();  ///< x, y, shear (0 here)
  double explained_m = 0.0;  ///< of surface on drawn walls, each scan where it fits best
};

/// Tries strains of x and y on a grid: at each, scans are moved to where they fit the strained drawing best,
/// each alone, and the surface that then lies on drawn walls is added up. Best first.
[[nodiscard]] std::vector<StrainPeak> search_strains(const WallIndex& drawing,
                                                     const std::vector<CalibrationKeyframe>& keyframes,
                                                     const CalibrationOptions& options);

/// Middle of the keyframes' positions, about which strains are meant.
[[nodiscard]] Point2<Map> middle_of(const std::vector<CalibrationKeyframe>& keyframes);

/// The pose in a true-to-scale plane of one that was measured on the drawing.
[[nodiscard]] Transform2<Map, Base> unstrained(const Transform2<Map, Base>& on_drawing,
                                               const StrainAbout& strained);

/// Metres of a keyframe's surface that lie on the strained drawing, those within some `scale_m` of a wall
/// less.
[[nodiscard]] double explained_m(const WallIndex& drawing, const StrainAbout& strained,
                                 const Transform2<Map, Base>& pose, const std::vector<SurfacePiece>& pieces,
                                 double scale_m, double beside_m);

/// The keyframe moved to where its pieces fit best, from within half a metre.
[[nodiscard]] Transform2<Map, Base> fit_keyframe(const WallIndex& drawing, const StrainAbout& strained,
                                                 const Transform2<Map, Base>& start,
                                                 const std::vector<SurfacePiece>& pieces,
                                                 const CalibrationOptions& options);

}  // namespace madori::localization
