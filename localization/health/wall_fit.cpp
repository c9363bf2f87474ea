#include "localization/health/wall_fit.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

/// How far an average over `length_m` goes towards a new value after `way_m`.
double gain(double way_m, double length_m) {
  return 1.0 - std::exp(-way_m / length_m);
}

}  // namespace

void WallFit::add(double on_walls, double path_m, double turned_rad) {
  if (!recent_) {
    usual_ = std::max(on_walls, options_.first_share);
    recent_ = usual_;
    return;
  }
  const double way_m = path_m + options_.way_m_per_rad * turned_rad;
  *recent_ += gain(way_m, options_.recent_m) * (on_walls - *recent_);
  usual_ += (is_poor() ? options_.slow_share : 1.0) * gain(way_m, options_.usual_m) * (on_walls - usual_);
}

}  // namespace madori::localization
