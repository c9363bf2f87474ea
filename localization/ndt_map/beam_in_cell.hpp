#pragma once

#include "localization/ndt_map/cell_gaussian.hpp"

namespace madori::localization {

/// A beam in the map's frame, heights above the floor; `way` is 0 at the sensor and 1 at its end.
struct MapBeam {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;     ///< the sensor
  double dx_m = 0.0, dy_m = 0.0, dz_m = 0.0;  ///< from there to the end
};

/// How surely, 0..1, a beam that was in the cell on [from, to] of its way would have ended on what the
/// Gaussian stands for, had that been there: it met the Gaussian at its likeliest point, in height as well,
/// and did not end on the same surface. NDT-OM's rule (Saarinen et al. 2013), the part of the sensor's noise
/// measured across the surface instead of along the beam, so that grazing beams refute nothing.
[[nodiscard]] double refutes(const MapBeam& beam, double from, double to, const CellGaussian& gaussian,
                             double surface_m);

}  // namespace madori::localization
