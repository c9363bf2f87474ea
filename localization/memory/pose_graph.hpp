#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// A measured motion between two keyframes: pose `to` seen from pose `from`.
struct RelativeFactor {
  int from = 0;
  int to = 0;
  Transform2<Base, Base> motion;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw), axes of `from`
  bool loop = false;  ///< a loop closure may be wrong: it gets a robust loss
};

/// A quadratic pull on one keyframe, Map axes: 1/2 d'Hd + g'd with d = pose - at.
struct UnaryFactor {
  int node = 0;
  Transform2<Map, Base> at;
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

struct GraphOptions {
  int max_iterations = 8;
  double loop_loss = 3.0;            ///< sigmas; beyond, a loop closure pulls less and less (Cauchy)
  double function_tolerance = 1e-5;  ///< relative change of the cost at which the solver stops
};

/// Least squares over all poses (Ceres). `poses` holds the start and gets the answer; the first pose is held
/// where no unary factor ties the graph to the map. Returns false when the solver failed, poses untouched.
bool optimise_graph(std::vector<Transform2<Map, Base>>& poses, const std::vector<RelativeFactor>& relative,
                    const std::vector<UnaryFactor>& unary, const GraphOptions& options = {});

/// Derivatives of a motion, (x, y, yaw) in the axes of `from`, by either pose, Map axes.
struct RelativeJacobians {
  Eigen::Matrix3d by_from, by_to;
};
/// Where `to` lies (dx, dy) from `from`, which is turned by `yaw_rad`.
[[nodiscard]] RelativeJacobians relative_jacobians(double yaw_rad, double dx_m, double dy_m);

/// The error of a factor in its own axes (x, y, yaw).
[[nodiscard]] Eigen::Vector3d relative_error(const RelativeFactor& factor, const Transform2<Map, Base>& from,
                                             const Transform2<Map, Base>& to);

}  // namespace madori::localization
