#include "localization/wall_tracker/nearby_rival.hpp"

#include <cmath>

#include "core/angle.hpp"
#include "localization/wall_tracker/explained.hpp"

namespace madori::localization {

using Pose = Transform2<Map, Base>;

bool NearbyRival::is_beside(const RegistrationResult& other, const RegistrationResult& here) const {
  const double apart = distance_m(other.map_from_base.translation(), here.map_from_base.translation());
  return other.inlier_fraction >= options_.sure_inliers && apart > options_.apart_m &&
         apart < options_.most_m;
}

std::optional<RegistrationResult> NearbyRival::best_on_ring(const ScanPoints& points, const SegmentGrid& grid,
                                                            const RegistrationResult& here,
                                                            double radius_m) const {
  const Pose& centre = here.map_from_base;
  std::optional<RegistrationResult> best;
  for (int k = 0; k < options_.directions; ++k) {
    const double a = 2.0 * kPi * k / options_.directions;
    const Pose start(centre.x_m() + radius_m * std::cos(a), centre.y_m() + radius_m * std::sin(a),
                     centre.yaw_rad());
    RegistrationResult there = segment_icp(points, grid, start, options_.icp);
    if (!is_beside(there, here)) continue;
    if (!best || explained(there, points) > explained(*best, points)) best = std::move(there);
  }
  return best;
}

RegistrationResult NearbyRival::begin(const ScanPoints& points, const SegmentGrid& grid,
                                      const RegistrationResult& fit) {
  reopen();
  RegistrationResult best = fit;
  double most = explained(fit, points) * (1.0 + options_.at_once);
  for (const double radius_m : {options_.ring_m, 2.0 * options_.ring_m}) {
    const auto there = best_on_ring(points, grid, fit, radius_m);
    if (!there || explained(*there, points) <= most) continue;
    most = explained(*there, points);
    best = *there;
  }
  return best;
}

bool NearbyRival::is_sure() const {
  const int votes = rival_->votes;
  const double enough = votes < options_.fewest_votes ? options_.clear_lead : options_.enough;
  return votes >= options_.fewest_where_clear && rival_->lead.mean(votes) >= enough &&
         rival_->lead.is_sure(votes, options_.lead_sigmas);
}

void NearbyRival::reopen() {
  votes_left_ = options_.most_votes;
  rival_.reset();
  since_ = {};
}

/// The rival as this scan sees it, or another one that explains more than both poses do.
std::optional<RegistrationResult> NearbyRival::best_rival(const ScanPoints& points, const SegmentGrid& grid,
                                                          const RegistrationResult& here) {
  std::optional<RegistrationResult> there;
  if (rival_) there = segment_icp(points, grid, rival_->pose, options_.icp);
  if (there && !is_beside(*there, here)) there.reset();
  if (!there) rival_.reset();
  auto another = best_on_ring(points, grid, here, options_.ring_m * (1 + votes_left_ % 2));
  if (!another || explained(*another, points) <= explained(there ? *there : here, points)) return there;
  const bool same = there && distance_m(there->map_from_base.translation(),
                                        another->map_from_base.translation()) < options_.apart_m;
  if (!same) rival_ = Rival{};
  return another;
}

std::optional<RegistrationResult> NearbyRival::observe(const ScanPoints& points, const SegmentGrid& grid,
                                                       const Pose& pose,
                                                       const Transform2<Base, Base>& motion) {
  if (rests()) return std::nullopt;
  if (rival_) rival_->pose = rival_->pose * motion;
  since_ = since_ * motion;
  if (std::hypot(since_.x_m(), since_.y_m()) < options_.every_m) return std::nullopt;
  since_ = {};
  const RegistrationResult here = segment_icp(points, grid, pose, options_.icp);
  if (here.inlier_fraction < options_.sure_inliers) return std::nullopt;
  --votes_left_;
  auto there = best_rival(points, grid, here);
  if (!there) return std::nullopt;
  rival_->pose = there->map_from_base;
  ++rival_->votes;
  rival_->lead.add(explained(*there, points) / explained(here, points) - 1.0);
  if (!is_sure()) return std::nullopt;
  reopen();
  return there;
}

}  // namespace madori::localization
