#pragma once

namespace madori::localization {

/// Principal axes of a plane covariance, floored for use: variances (m^2), unit vector of the smaller one.
struct GaussianAxes {
  double large_m2 = 0.0;
  double small_m2 = 0.0;
  double normal_x = 0.0;
  double normal_y = 0.0;

  /// A surface, not a corner nor a heap: with 3 cm of noise a face has a fifth.
  [[nodiscard]] bool is_surface() const { return small_m2 <= 0.5 * large_m2; }
};

/// The end points that fell into a cell as a normal distribution, and their heights. Moments are those of the
/// population until `samples` reaches its cap; from there on a new point weighs 1 / (cap + 1).
struct CellGaussian {
  static constexpr double kFloorM = 0.02;     ///< standard deviation of a lidar's range at least
  static constexpr double kFlattest = 0.001;  ///< smaller over larger variance at least

  double x_m = 0.0, y_m = 0.0;                     ///< mean, in the map's frame
  float xx_m2 = 0.0F, xy_m2 = 0.0F, yy_m2 = 0.0F;  ///< covariance, without any floor
  float z_m = 0.0F, zz_m2 = 0.0F;                  ///< height above the floor: mean, variance
  float samples = 0.0F;                            ///< 0: no Gaussian yet

  [[nodiscard]] bool empty() const { return samples == 0.0F; }
  /// Takes one end point: Eq. (4.4) of the lifelong-localization source, covariance before mean.
  void add(double at_x_m, double at_y_m, double at_z_m, double most_samples);
  /// Both populations as one.
  void merge(const CellGaussian& other, double most_samples);
  [[nodiscard]] GaussianAxes axes() const;
};

/// How surely both are of one surface, 0..1: by how far their means lie apart across the flatter one, in
/// standard deviations, `sigma_m` among them (range and pose); 0 where they run across each other.
[[nodiscard]] double same_surface(const CellGaussian& a, const CellGaussian& b, double sigma_m);

}  // namespace madori::localization
