#pragma once

#include <Eigen/Core>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/ndt_map/gaussian_pyramid.hpp"

namespace madori::localization {

struct MapRegistrationOptions {
  int max_iterations = 40;  ///< a level
  double step_limit_m = 1e-4;
  double step_limit_rad = 1e-5;
  double half_m = 0.6;          ///< window around the guess in which the answer is sought, x and y ...
  double half_rad = 0.21;       ///< ... and turns
  std::size_t first_level = 1;  ///< of the pyramid at which all of the window is looked at
  double reach_m = 8.0;         ///< what is that far away moves by half a cell from one turn to the next
  std::size_t carried = 12;     ///< of the best of them that are refined
};

/// How one map of Gaussians lies on another.
struct MapRegistration {
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  bool converged = false;
  double score = 0.0;  ///< 0..1, mean over the source's finest cells of how well each meets a Gaussian
  int matched = 0;     ///< finest cells with a Gaussian of the target within three standard deviations
  double chi2 = 0.0;   ///< of those, squared distances in standard deviations; 2 a cell is usual
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw)

  [[nodiscard]] Transform2<Map, Map> on_map() const { return {x_m, y_m, yaw_rad}; }
  [[nodiscard]] Transform2<Map, Base> pose() const { return {x_m, y_m, yaw_rad}; }
};

/// Lays `source` on `target` from a guess, coarse cells first: maximises sum exp(-1/2 d' C^-1 d) over pairs
/// of near cells, with C = R S_i R' + S_j (lifelong-localization source, 4.2.2; Stoyanov et al. 2012), by
/// damped Gauss-Newton steps. Of two maps (the answer is where the source's frame lies in the target's), or
/// of a scan in Base and a map.
[[nodiscard]] MapRegistration lay_on(const GaussianPyramid& target, const GaussianPyramid& source,
                                     const Transform2<Map, Map>& guess,
                                     const MapRegistrationOptions& options = {});

}  // namespace madori::localization
