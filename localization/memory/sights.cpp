#include "localization/memory/sights.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr double kGapRad = 0.045;  // beams this near to each other leave no gap between them,
constexpr double kGapM = 0.15;     // nor do points of one surface

double turn_of(double dx, double dy) {
  const double turn = std::atan2(dy, dx) / (2.0 * kPi);
  return turn < 0.0 ? turn + 1.0 : turn;
}

double margin_m(double distance_m) {
  return kSightMarginM + kSightMarginShare * distance_m;
}

}  // namespace

void SightRing::mark(std::size_t bin, double range_m) {
  Bin& b = bins_[bin % kBins];
  const auto r = static_cast<float>(range_m);
  b.near_m = b.far_m < 0.0F ? r : std::min(b.near_m, r);
  b.far_m = std::max(b.far_m, r);
}

SightRing::SightRing(const SurfaceScan& scan) : sensor_(scan.sensor), bins_(kBins) {
  double last_turn = 0.0, last_range = -1.0;
  for (const SurfacePoint& p : scan.points) {  // sorted by bearing
    const double dx = p.x_m - sensor_.x_m, dy = p.y_m - sensor_.y_m;
    const double turn = turn_of(dx, dy), range = std::hypot(dx, dy);
    const auto at = static_cast<std::size_t>(turn * kBins);
    mark(at, range);
    reach_m_ = std::max(reach_m_, range);
    const double gap = (turn - last_turn) * 2.0 * kPi;
    if (last_range >= 0.0 && gap > 0.0 && (gap < kGapRad || gap * range < kGapM)) {
      for (auto k = static_cast<std::size_t>(last_turn * kBins) + 1; k < at; ++k) {
        mark(k, range);
        mark(k, last_range);
      }
    }
    last_turn = turn;
    last_range = range;
  }
}

/// The bin of a direction with what is seen right beside it.
SightRing::Bin SightRing::towards(double dx, double dy) const {
  const auto at = static_cast<std::size_t>(turn_of(dx, dy) * kBins);
  Bin b = bins_[at % kBins];
  if (b.far_m < 0.0F) return b;
  for (const Bin* beside : {&bins_[(at + 1) % kBins], &bins_[(at + kBins - 1) % kBins]}) {
    if (beside->far_m < 0.0F) continue;
    b.near_m = std::min(b.near_m, beside->near_m);
    b.far_m = std::max(b.far_m, beside->far_m);
  }
  return b;
}

SightCount SightRing::of(const SurfaceScan& other, const Transform2<Base, Base>& here_from_there) const {
  SightCount count;
  for (const SurfacePoint& p : other.points) {
    const Point2<Base> q = here_from_there * Point2<Base>{p.x_m, p.y_m};
    const double dx = q.x_m - sensor_.x_m, dy = q.y_m - sensor_.y_m;
    const double distance = std::hypot(dx, dy);
    const Bin seen = towards(dx, dy);
    if (seen.far_m < 0.0F) continue;
    if (distance < seen.near_m - margin_m(distance)) {
      ++count.through;
    } else if (distance < seen.far_m + margin_m(distance)) {
      ++count.agree;
    }
  }
  return count;
}

SightCount sights_of_each_other(const SurfaceScan& here, const SurfaceScan& there,
                                const Transform2<Base, Base>& here_from_there) {
  return sights_of_each_other(here, SightRing(here), there, here_from_there);
}

SightCount sights_of_each_other(const SurfaceScan& here, const SightRing& ring, const SurfaceScan& there,
                                const Transform2<Base, Base>& here_from_there) {
  SightCount sights = ring.of(there, here_from_there);
  sights += SightRing(there).of(here, here_from_there.inverse());
  return sights;
}

Look SightRing::at(const Point2<Base>& place) const {
  const double dx = place.x_m - sensor_.x_m, dy = place.y_m - sensor_.y_m;
  const double distance = std::hypot(dx, dy);
  const Bin seen = towards(dx, dy);
  if (seen.far_m < 0.0F) return Look::Nothing;
  const double margin = margin_m(distance);
  if (distance < seen.near_m - margin) return Look::Through;
  const bool hit = std::abs(distance - seen.near_m) < margin || std::abs(distance - seen.far_m) < margin;
  return hit ? Look::Hit : Look::Nothing;
}

}  // namespace madori::localization
