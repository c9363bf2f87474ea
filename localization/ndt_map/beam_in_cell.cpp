#include "localization/ndt_map/beam_in_cell.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

/// Squared distance of (x, y) from the mean in standard deviations, by the floored axes.
double mahalanobis2(const GaussianAxes& axes, double x, double y) {
  const double across = axes.normal_x * x + axes.normal_y * y;
  const double along = axes.normal_x * y - axes.normal_y * x;
  return across * across / axes.small_m2 + along * along / axes.large_m2;
}

/// How surely the end is not on the surface: a line's Gaussian stands for a surface that goes on.
double ended_elsewhere(const MapBeam& beam, const CellGaussian& g, const GaussianAxes& axes,
                       double surface_m) {
  constexpr double kLine = 0.1;  // smaller over larger variance
  const double x = beam.x_m + beam.dx_m - g.x_m;
  const double y = beam.y_m + beam.dy_m - g.y_m;
  const double noise_m2 = surface_m * surface_m;
  const double across = axes.normal_x * x + axes.normal_y * y;
  const double along = axes.normal_x * y - axes.normal_y * x;
  double squared = across * across / (axes.small_m2 + noise_m2);
  if (axes.small_m2 > kLine * axes.large_m2) squared += along * along / (axes.large_m2 + noise_m2);
  return -std::expm1(-0.5 * squared);
}

}  // namespace

double refutes(const MapBeam& beam, double from, double to, const CellGaussian& gaussian, double surface_m) {
  constexpr double kHeightNoiseM2 = 0.05 * 0.05;
  const GaussianAxes axes = gaussian.axes();
  const double across_d = axes.normal_x * beam.dx_m + axes.normal_y * beam.dy_m;
  const double along_d = axes.normal_x * beam.dy_m - axes.normal_y * beam.dx_m;
  const double mx = gaussian.x_m - beam.x_m;
  const double my = gaussian.y_m - beam.y_m;
  const double across_m = axes.normal_x * mx + axes.normal_y * my;
  const double along_m = axes.normal_x * my - axes.normal_y * mx;
  const double curve = across_d * across_d / axes.small_m2 + along_d * along_d / axes.large_m2;
  if (!(curve > 0.0)) return 0.0;
  const double likeliest = (across_d * across_m / axes.small_m2 + along_d * along_m / axes.large_m2) / curve;
  const double t = std::clamp(likeliest, from, to);
  const double height = beam.z_m + t * beam.dz_m - static_cast<double>(gaussian.z_m);
  const double squared = mahalanobis2(axes, t * beam.dx_m - mx, t * beam.dy_m - my) +
                         height * height / (static_cast<double>(gaussian.zz_m2) + kHeightNoiseM2);
  return std::exp(-0.5 * squared) * ended_elsewhere(beam, gaussian, axes, surface_m);
}

}  // namespace madori::localization
