#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "mapping/site/strict_yaml.hpp"

namespace madori::app {

/// Names of the elements xx xy xz yy yz zz of a symmetric 3 x 3 matrix in a file.
using CovarianceKeys = std::array<const char*, 6>;

/// The section `covariance` of a file; every element within +-`limit`. Throws Error where one is missing or
/// another stands there.
[[nodiscard]] Eigen::Matrix3d read_covariance(mapping::StrictYaml& file, const CovarianceKeys& keys,
                                              double limit);
/// The line that read_covariance() reads.
[[nodiscard]] std::string covariance_yaml(const Eigen::Matrix3d& covariance, const CovarianceKeys& keys);

}  // namespace madori::app
