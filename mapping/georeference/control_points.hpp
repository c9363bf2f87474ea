#pragma once

#include <string>
#include <vector>

#include "mapping/georeference/scale_estimate.hpp"

namespace madori::mapping {

/// A drawing pixel whose place on Earth is known.
struct ControlPoint {
  double u = 0.0;
  double v = 0.0;
  LatLon place;
};

/// "u,v=LAT,LON". Throws Error on anything else.
[[nodiscard]] ControlPoint parse_control_point(const std::string& text);

/// Throws Error on a point that lies off the drawing.
void require_on_drawing(const std::vector<ControlPoint>& points, const DrawingRecord& drawing);

/// N-point similarity between drawing and ground (S. Umeyama, "Least-squares estimation of transformation
/// parameters between two point patterns", PAMI 1991, eq. 40-43) in a local east-north-up plane
/// (GeographicLib). error = sqrt(sum r^2 / (n - 2)). Two points fit exactly and are called unverified; of
/// three or more a mirrored drawing is recognised; of four or more a different scale along u and v, and an
/// outlier. `height_px` of the drawing places the Map origin. Throws Error on fewer than two distinct points.
[[nodiscard]] ScaleEstimate fit_control_points(const std::vector<ControlPoint>& points, int height_px);

}  // namespace madori::mapping
