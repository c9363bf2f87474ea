#include "localization/health/wall_fit.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

constexpr double kRecentM = 5.0;     // of way, over which the newest scans are averaged
constexpr double kUsualM = 20.0;     // of way, over which it is learned what is usual
constexpr double kSlowShare = 0.3;   // of that, while the newest fit poorly: so that becomes usual slowly
constexpr double kWayMPerRad = 0.3;  // turning shows other walls, too

/// How far an average over `length_m` goes towards a new value after `way_m`.
double gain(double way_m, double length_m) {
  return 1.0 - std::exp(-way_m / length_m);
}

}  // namespace

void WallFit::add(double on_walls, double path_m, double turned_rad) {
  if (!recent_) {
    usual_ = std::max(on_walls, kFirstShare);
    recent_ = usual_;
    return;
  }
  const double way_m = path_m + kWayMPerRad * turned_rad;
  *recent_ += gain(way_m, kRecentM) * (on_walls - *recent_);
  usual_ += (is_poor() ? kSlowShare : 1.0) * gain(way_m, kUsualM) * (on_walls - usual_);
}

}  // namespace madori::localization
