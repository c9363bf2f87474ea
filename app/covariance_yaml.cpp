#include "app/covariance_yaml.hpp"

#include <fmt/format.h>

namespace madori::app {

Eigen::Matrix3d read_covariance(mapping::StrictYaml& file, const CovarianceKeys& keys, double limit) {
  auto section = file.section("covariance");
  Eigen::Matrix3d covariance;
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      covariance(i, j) = covariance(j, i) = section.number(keys[at++], -limit, limit);
  section.refuse_unknown_keys();
  return covariance;
}

std::string covariance_yaml(const Eigen::Matrix3d& covariance, const CovarianceKeys& keys) {
  std::string text = "covariance: {";
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j, ++at)
      text += fmt::format("{}{}: {:.9e}", at == 0 ? "" : ", ", keys[at], covariance(i, j));
  return text + "}\n";
}

}  // namespace madori::app
