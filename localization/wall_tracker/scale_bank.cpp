#include "localization/wall_tracker/scale_bank.hpp"

#include <algorithm>
#include <cmath>

#include "localization/wall_tracker/explained.hpp"

namespace madori::localization {
namespace {

ScanPoints scaled(const ScanPoints& points, double factor) {
  ScanPoints result = points;
  const auto f = static_cast<float>(factor);
  for (float& x : result.x_m) x *= f;
  for (float& y : result.y_m) y *= f;
  return result;
}

}  // namespace

ScaleBank::ScaleBank(const ScaleBankOptions& options) : options_(options) {
  begin_stage(0, {});
}

/// Does it explain surely more, or surely less, than the size believed?
bool ScaleBank::is_sure(const Member& m) const {
  return m.lead.is_sure(stretches_, options_.lead_sigmas);
}

void ScaleBank::begin_stage(int stage, const Transform2<Map, Base>& pose) {
  stage_ = stage;
  scans_ = stretches_ = 0;
  best_pose_ = pose;
  members_.clear();
  if (sleeps()) return;
  for (int i = -options_.beside; i <= options_.beside; ++i)
    members_.push_back({.excess = believed_ + i * step(), .pose = pose});
  if (believed_ != 0.0) members_.push_back({.excess = 0.0, .pose = pose});
}

ScanPoints ScaleBank::applied(const ScanPoints& points) const {
  return believed_ == 0.0 ? points : scaled(points, factor());
}

void ScaleBank::start_at(const Transform2<Map, Base>& pose) {
  placed_ = true;
  since_ = {};
  best_pose_ = pose;
  for (Member& m : members_) m.pose = pose;
}

void ScaleBank::ask(Member& member, const ScanPoints& points, const SegmentGrid& grid,
                    const Transform2<Map, Base>& start) {
  const ScanPoints sized = scaled(points, 1.0 + member.excess);
  const RegistrationResult fit = segment_icp(sized, grid, start, options_.icp);
  if (fit.inlier_fraction < options_.sure_inliers ||
      distance_m(fit.map_from_base.translation(), start.translation()) > options_.most_correction_m)
    return;
  const double share = explained(fit, sized);
  if (share <= member.explained) return;
  member.explained = share;
  member.pose = fit.map_from_base;
}

bool ScaleBank::observe(const ScanPoints& seen, const SegmentGrid& grid,
                        const Transform2<Base, Base>& motion) {
  if (sleeps() || !placed_) return false;
  since_ = since_ * motion;
  if (std::hypot(since_.x_m(), since_.y_m()) < options_.every_m &&
      std::abs(since_.yaw_rad()) < options_.every_rad)
    return false;
  for (Member& m : members_) {
    const Transform2<Map, Base> carried = m.pose * since_;
    m.pose = carried;
    m.explained = 0.0;
    ask(m, seen, grid, carried);
  }
  since_ = {};
  if (believed_member().explained == 0.0) return false;
  const auto best = std::max_element(members_.begin(), members_.end(), [](const Member& a, const Member& b) {
    return a.explained < b.explained;
  });
  ask(members_[static_cast<std::size_t>(scans_ + stretches_) % members_.size()], seen, grid, best->pose);
  for (Member& m : members_) m.stretch += m.explained - believed_member().explained;
  if (++scans_ < options_.scans_a_stretch) return false;
  end_stretch();
  return stretches_ >= options_.fewest_where_clear && decide();
}

void ScaleBank::end_stretch() {
  for (Member& m : members_) {
    m.lead.add(m.stretch / scans_);
    m.stretch = 0.0;
  }
  scans_ = 0;
  ++stretches_;
}

bool ScaleBank::decide() {
  const Member believed = believed_member();
  const Member best =
      *std::max_element(members_.begin(), members_.end(),
                        [](const Member& a, const Member& b) { return a.lead.sum < b.lead.sum; });
  const bool drawn = best.excess == 0.0;  // the drawing is right until it is surely not
  const bool early = stretches_ < options_.fewest_stretches;
  const double enough = early         ? options_.clear_lead
                        : drawn       ? 0.0
                        : stage_ == 0 ? options_.coarse_lead
                                      : options_.fine_lead;
  if (best.excess != believed.excess && best.lead.sum > enough * stretches_ && is_sure(best)) {
    const bool within = std::abs(best.excess - believed_) < (options_.beside - 0.5) * step();
    believed_ = best.excess;
    begin_stage(within ? 1 : 0, best.pose);
    return true;
  }
  if (early) return false;
  const bool all_sure = std::all_of(members_.begin(), members_.end(), [&](const Member& m) {
    return m.excess == believed.excess || is_sure(m);
  });
  if (stage_ == 0 && all_sure)
    begin_stage(1, believed.pose);
  else if (all_sure || stretches_ >= options_.most_stretches)
    begin_stage(believed_ == 0.0 ? kStages : stage_, believed.pose);
  return false;
}

}  // namespace madori::localization
