#pragma once

#include <vector>

#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// A straight stretch of surface as one scan saw it: what is left of its returns for measuring the drawing.
struct SurfacePiece {
  Point2<Base> centre;
  double normal_x = 0.0;  ///< unit, Base frame, towards the sensor
  double normal_y = 0.0;
  double length_m = 0.0;
};

struct SurfacePieceOptions {
  double longest_m = 1.0;    ///< a longer surface makes several
  double shortest_m = 0.35;  ///< shorter ones are of furniture as often as of walls
  int fewest_points = 4;
  double gap_m = 0.3;        ///< plus 5 % of the range: neighbours farther apart are of two surfaces
  double most_rms_m = 0.03;  ///< of the returns off their line
};

/// Runs of neighbouring returns that lie on a line (total least squares), at most `longest_m` each.
[[nodiscard]] std::vector<SurfacePiece> surface_pieces(const SurfaceScan& scan,
                                                       const SurfacePieceOptions& options = {});

}  // namespace madori::localization
