#include "localization/global/global_localizer.hpp"

#include <algorithm>
#include <cmath>

#include "localization/global/refinement.hpp"
#include "localization/global/view_search.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

constexpr std::size_t kCandidates = 1000;  ///< views most like the scan's that are looked at closer
constexpr std::size_t kRefined = 60;       ///< of these, as many are registered
constexpr double kRemembered = 1e-3;       // hypotheses below this probability are dropped

/// The hypotheses of the answer before, where the vehicle has moved to since.
struct Carried {
  Carried(const GlobalAnswer& before, const Transform2<Base, Base>& moved) {
    for (const Hypothesis& h : before.hypotheses) {
      if (h.probability < kRemembered) continue;
      poses.push_back(h.fit.map_from_base * moved);
      prior.push_back(std::log(h.probability));
      least = std::min(least, prior.back());
    }
  }

  /// Log-probability that the scans before give a pose.
  [[nodiscard]] double log_prior(const Pose& pose) const {
    constexpr double kSameM = 0.5;  // farther off than odometry errs between two scans
    constexpr double kSameRad = 0.15;
    double carried = least + std::log(kRemembered);  // a place that nothing spoke for until now
    for (std::size_t i = 0; i < prior.size(); ++i)
      if (same_place(pose, poses[i], kSameM, kSameRad)) carried = std::max(carried, prior[i]);
    return carried;
  }

  std::vector<Pose> poses;
  std::vector<double> prior;  ///< log-probability, one a pose
  double least = 0.0;         ///< of these
};

}  // namespace

GlobalLocalizer::GlobalLocalizer(const mapping::Walls& walls, std::optional<PlaceIndex> index)
    : tables_(walls, {.hit_sigma_m = 0.04}),
      index_(index ? std::move(*index) : PlaceIndex(walls, tables_.distance)) {}

std::vector<Pose> GlobalLocalizer::candidates(const ScanPoints& points) const {
  return search_views(points, index_, tables_.coarse, kCandidates, kRefined);
}

double GlobalLocalizer::lead_of_nearby(const ScanPoints& points, const Pose& map_from_base) const {
  return localization::lead_of_nearby(points, tables_.coarse, map_from_base);
}

GlobalAnswer GlobalLocalizer::judge(const ScanPoints& points, const std::vector<Pose>& poses) const {
  return decide(refine_poses(points, poses, tables_));
}

GlobalAnswer GlobalLocalizer::locate(const ScanPoints& points) const {
  return judge(points, candidates(points));
}

GlobalAnswer GlobalLocalizer::locate(const ScanPoints& points, const GlobalAnswer& before,
                                     const Transform2<Base, Base>& moved) const {
  const Carried carried(before, moved);
  std::vector<Pose> poses = carried.poses;
  for (const Pose& fresh : candidates(points)) poses.push_back(fresh);
  std::vector<Hypothesis> hypotheses = refine_poses(points, poses, tables_);
  for (Hypothesis& h : hypotheses) h.log_likelihood += carried.log_prior(h.fit.map_from_base);
  return decide(std::move(hypotheses));
}

}  // namespace madori::localization
