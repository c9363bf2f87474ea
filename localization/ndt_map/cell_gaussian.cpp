#include "localization/ndt_map/cell_gaussian.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {

void CellGaussian::add(double at_x_m, double at_y_m, double at_z_m, double most_samples) {
  const double n = samples;
  const double old = n / (n + 1.0);  // alpha
  const double fresh = 1.0 - old;
  const double dx = x_m - at_x_m;
  const double dy = y_m - at_y_m;
  const double dz = static_cast<double>(z_m) - at_z_m;
  xx_m2 = static_cast<float>(old * (xx_m2 + fresh * dx * dx));
  xy_m2 = static_cast<float>(old * (xy_m2 + fresh * dx * dy));
  yy_m2 = static_cast<float>(old * (yy_m2 + fresh * dy * dy));
  zz_m2 = static_cast<float>(old * (zz_m2 + fresh * dz * dz));
  x_m -= fresh * dx;
  y_m -= fresh * dy;
  z_m -= static_cast<float>(fresh * dz);
  samples = static_cast<float>(std::min(n + 1.0, most_samples));
}

void CellGaussian::merge(const CellGaussian& other, double most_samples) {
  if (other.empty()) return;
  const double both = static_cast<double>(samples) + other.samples;
  const double theirs = other.samples / both;
  const double ours = 1.0 - theirs;
  const double dx = other.x_m - x_m;
  const double dy = other.y_m - y_m;
  const double dz = static_cast<double>(other.z_m) - z_m;
  const auto variance = [&](float a, float b, double d2) {
    return static_cast<float>(ours * a + theirs * b + ours * theirs * d2);
  };
  xx_m2 = variance(xx_m2, other.xx_m2, dx * dx);
  xy_m2 = variance(xy_m2, other.xy_m2, dx * dy);
  yy_m2 = variance(yy_m2, other.yy_m2, dy * dy);
  zz_m2 = variance(zz_m2, other.zz_m2, dz * dz);
  x_m += theirs * dx;
  y_m += theirs * dy;
  z_m += static_cast<float>(theirs * dz);
  samples = static_cast<float>(std::min(both, most_samples));
}

GaussianAxes CellGaussian::axes() const {
  const double xx = xx_m2, xy = xy_m2, yy = yy_m2;
  const double middle = 0.5 * (xx + yy);
  const double spread = std::hypot(0.5 * (xx - yy), xy);
  const double along = 0.5 * std::atan2(2.0 * xy, xx - yy);
  GaussianAxes axes;
  axes.large_m2 = std::max(middle + spread, kFloorM * kFloorM);
  axes.small_m2 = std::max({middle - spread, kFlattest * axes.large_m2, kFloorM * kFloorM});
  axes.normal_x = -std::sin(along);
  axes.normal_y = std::cos(along);
  return axes;
}

double same_surface(const CellGaussian& a, const CellGaussian& b, double sigma_m) {
  const GaussianAxes of_a = a.axes(), of_b = b.axes();
  const double cosine = of_a.normal_x * of_b.normal_x + of_a.normal_y * of_b.normal_y;
  if (of_a.is_surface() && of_b.is_surface() && cosine * cosine < 0.5) return 0.0;
  const bool a_is_flatter = of_a.small_m2 * of_b.large_m2 < of_b.small_m2 * of_a.large_m2;
  const GaussianAxes& flat = a_is_flatter ? of_a : of_b;
  const CellGaussian& other = a_is_flatter ? b : a;
  const double x = flat.normal_x, y = flat.normal_y;
  const double apart_m = x * (a.x_m - b.x_m) + y * (a.y_m - b.y_m);
  const double theirs_m2 = x * x * other.xx_m2 + 2.0 * x * y * other.xy_m2 + y * y * other.yy_m2;
  return std::exp(-0.5 * apart_m * apart_m / (flat.small_m2 + theirs_m2 + sigma_m * sigma_m));
}

}  // namespace madori::localization
