#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// Pose hypotheses as structure of arrays. x and y are metres from `origin`, which lies on the site, so that
/// a float is good to a tenth of a millimetre on any site; the yaw is not wrapped.
struct Particles {
  Point2<Map> origin;
  std::vector<float> x_m;
  std::vector<float> y_m;
  std::vector<float> yaw_rad;

  [[nodiscard]] std::size_t size() const { return x_m.size(); }
  void add(const Transform2<Map, Base>& map_from_base) {
    x_m.push_back(static_cast<float>(map_from_base.x_m() - origin.x_m));
    y_m.push_back(static_cast<float>(map_from_base.y_m() - origin.y_m));
    yaw_rad.push_back(static_cast<float>(map_from_base.yaw_rad()));
  }
  [[nodiscard]] Transform2<Map, Base> pose(std::size_t i) const {
    return {origin.x_m + x_m[i], origin.y_m + y_m[i], yaw_rad[i]};
  }
};

}  // namespace madori::localization
