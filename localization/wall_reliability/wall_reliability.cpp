#include "localization/wall_reliability/wall_reliability.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

constexpr double kStepM = 0.25;    // of driving between two scans that are looked at
constexpr double kStepRad = 0.26;  // or of turning: other walls come into view
constexpr double kLeastSigmaM = 0.01;

/// Counts fade so that what was seen long ago does not outvote what is there now.
void fade(WallBelief& belief, double most) {
  const double looks = belief.looks();
  if (looks <= most) return;
  for (double* count : {&belief.in_place, &belief.beside, &belief.missed}) *count *= most / looks;
}

/// A surface beside the drawn wall: joins the one known so far, or wears it down and takes its place.
void see_beside(WallBelief& belief, const WallLook& look, double same_place_m) {
  const double variance = look.sigma_m * look.sigma_m;
  const bool same = std::abs(look.offset_m - belief.offset_m) < same_place_m + 2.0 * look.sigma_m;
  if (belief.beside >= 1.0 && !same) {
    belief.beside -= 1.0;
  } else if (belief.beside < 1.0) {
    belief.beside = 1.0;
    belief.offset_m = look.offset_m;
    belief.offset_sigma_m = look.sigma_m;
  } else {
    const double known = belief.offset_sigma_m * belief.offset_sigma_m;
    belief.offset_m = (belief.offset_m * variance + look.offset_m * known) / (variance + known);
    belief.offset_sigma_m = std::max(kLeastSigmaM, std::sqrt(variance * known / (variance + known)));
    belief.beside += 1.0;
  }
}

}  // namespace

const char* to_string(WallState state) {
  switch (state) {
    case WallState::Unseen:
      return "unseen";
    case WallState::Confirmed:
      return "confirmed";
    case WallState::Missing:
      return "missing";
    case WallState::Displaced:
      return "displaced";
  }
  return "unseen";
}

WallReliability::WallReliability(const mapping::Walls& walls, const ReliabilityOptions& options)
    : options_(options),
      cells_(walls, options.cell_m),
      index_(walls),
      beliefs_(cells_.size()),
      last_(cells_.size()) {}

bool WallReliability::is_due(const PoseEstimate& pose) const {
  if (pose.health.state != LocalizationState::Localized) return false;
  const Transform2<Base, Base> moved = before_.inverse() * pose.map_from_base;
  return !moving_ || std::hypot(moved.x_m(), moved.y_m()) >= kStepM || std::abs(moved.yaw_rad()) >= kStepRad;
}

void WallReliability::observe(const SurfaceScan& scan, const PoseEstimate& pose) {
  if (!is_due(pose)) return;
  const Point2<Map> here = pose.map_from_base.translation();
  if (moving_) driven_m_ += distance_m(before_.translation(), here);
  before_ = pose.map_from_base;
  moving_ = true;
  for (const WallLook& look :
       wall_looks(cells_, index_, scan, pose.map_from_base, pose.covariance, options_.look)) {
    LastLook& last = last_[look.cell];
    const bool apart = distance_m(last.place, here) >= options_.apart_m;
    if (!apart && driven_m_ - last.driven_m < options_.later_m) continue;
    last = {here, driven_m_};
    learn(look);
  }
}

void WallReliability::learn(const WallLook& look) {
  WallBelief& belief = beliefs_[look.cell];
  const int beams = look.ended + look.passed;
  if (beams < 2) return;
  if (look.passed > look.ended) {
    belief.missed += 1.0;
  } else if (look.sigma_m > options_.most_sigma_m) {
    return;
  } else if (std::abs(look.offset_m) < std::max(options_.in_place_m, 2.0 * look.sigma_m)) {
    belief.in_place += 1.0;
    belief.drawn_offset_m += (look.offset_m - belief.drawn_offset_m) / belief.in_place;
  } else {
    see_beside(belief, look, options_.same_place_m);
  }
  fade(belief, options_.most_looks);
}

WallState WallReliability::state(std::size_t cell) const {
  const WallBelief& b = beliefs_[cell];
  if (b.looks() < options_.enough_looks) return WallState::Unseen;
  if (b.missed > b.in_place && b.missed > b.beside) return WallState::Missing;
  return b.beside > b.in_place ? WallState::Displaced : WallState::Confirmed;
}

double WallReliability::share_in_place(std::size_t cell) const {
  const WallBelief& b = beliefs_[cell];
  return (b.in_place + options_.prior_in_place) / (b.looks() + options_.prior_in_place + 0.5);
}

}  // namespace madori::localization
