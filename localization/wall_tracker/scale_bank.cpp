#include "localization/wall_tracker/scale_bank.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

ScanPoints scaled(const ScanPoints& points, double factor) {
  ScanPoints result = points;
  const auto f = static_cast<float>(factor);
  for (float& x : result.x_m) x *= f;
  for (float& y : result.y_m) y *= f;
  return result;
}

/// Share of the scan's weight on drawn walls, those beside them less.
double explained(const RegistrationResult& fit, const ScanPoints& points) {
  double all = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) all += points.weight_of(i);
  return all > 0.0 ? (fit.hessian(0, 0) + fit.hessian(1, 1)) / all : 0.0;
}

}  // namespace

ScaleBank::ScaleBank(const ScaleBankOptions& options) : options_(options) {
  begin_stage(0);
}

/// Does it explain surely more, or surely less, than the size believed?
bool ScaleBank::is_sure(const Member& m) const {
  const double mean = m.lead / scans_;
  const double variance = std::max(1e-12, m.lead2 / scans_ - mean * mean);
  return mean * mean * scans_ > options_.lead_sigmas * options_.lead_sigmas * variance;
}

void ScaleBank::begin_stage(int stage) {
  stage_ = stage;
  scans_ = 0;
  members_.clear();
  if (sleeps()) return;
  for (int i = -options_.beside; i <= options_.beside; ++i)
    members_.push_back({.excess = believed_ + i * step(), .pose = best_pose_});
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
  const auto believed = static_cast<std::size_t>(options_.beside);
  if (members_[believed].explained == 0.0) return false;
  const Member best =
      *std::max_element(members_.begin(), members_.end(),
                        [](const Member& a, const Member& b) { return a.explained < b.explained; });
  ask(members_[static_cast<std::size_t>(scans_) % members_.size()], seen, grid, best.pose);
  const double middle = members_[believed].explained;
  for (Member& m : members_) {
    const double lead = m.explained - middle;
    m.lead += lead;
    m.lead2 += lead * lead;
  }
  ++scans_;
  return decide();
}

bool ScaleBank::decide() {
  if (scans_ < options_.fewest_scans) return false;
  const auto believed = members_.begin() + options_.beside;
  const auto best = std::max_element(members_.begin(), members_.end(),
                                     [](const Member& a, const Member& b) { return a.lead < b.lead; });
  const double enough = stage_ == 0 ? options_.coarse_lead : options_.fine_lead;
  if (best != believed && best->lead > enough * scans_ && is_sure(*best)) {
    believed_ = best->excess;
    best_pose_ = best->pose;
    const bool at_the_edge = best == members_.begin() || best == members_.end() - 1;
    begin_stage(at_the_edge ? stage_ : stage_ + 1);
    return true;
  }
  const bool all_sure = std::all_of(members_.begin(), members_.end(), [&](const Member& m) {
    return m.excess == believed->excess || is_sure(m);
  });
  if (best == believed && all_sure) {
    best_pose_ = believed->pose;
    begin_stage(stage_ + 1);
  } else if (scans_ >= options_.most_scans) {
    begin_stage(kStages);
  }
  return false;
}

}  // namespace madori::localization
