#include "localization/landmarks/place_sense.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization::landmarks {

void PlaceSense::move(double way_m, double turn_rad) {
  driven_m_ += way_m;
  yaw_rad_ += turn_rad;
  headings_.push_back({driven_m_, yaw_rad_});
}

bool PlaceSense::at_a_place(const Surroundings& seen) {
  while (!headings_.empty() && driven_m_ - headings_.front().path_m > 0.5 * seen.corridor_width_m)
    headings_.pop_front();
  double turned = 0.0;
  for (const Heading& h : headings_) turned = std::max(turned, std::abs(yaw_rad_ - h.yaw_rad));
  const bool steady = seen.openings == openings_before_;
  openings_before_ = seen.openings;
  const bool crossing = steady && openings_ >= 0 && seen.openings > std::max(openings_, 2);
  if (steady) openings_ = seen.openings;
  return crossing || turned > turning_point_rad_;
}

}  // namespace madori::localization::landmarks
