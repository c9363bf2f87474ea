#include "localization/global/refinement.hpp"

#include <algorithm>
#include <cmath>

#include "localization/global/global_answer.hpp"
#include "localization/global/scan_noise.hpp"
#include "localization/registration/segment_icp.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

constexpr double kSamePlaceM = 0.4;  ///< poses nearer than both are one hypothesis
constexpr double kSamePlaceRad = 0.15;
constexpr double kThroughWallNats = 3.0;  ///< against a pose, for each effective beam through a wall

/// Candidates are near: a wide start would only draw them to the wall beside.
SegmentIcpOptions near_start() {
  SegmentIcpOptions near;
  near.first_scale_m = 0.5;
  near.coarse_points = 180;
  return near;
}

/// Starts beside the likeliest hypotheses: a wall has two faces, and a scan that lies on the wrong ones is a
/// local optimum as far off as the wall is thick.
std::vector<Pose> other_faces(const std::vector<Hypothesis>& hypotheses) {
  constexpr std::size_t kHypotheses = 3;
  constexpr int kDirections = 8;
  std::vector<Pose> starts;
  for (std::size_t i = 0; i < std::min(kHypotheses, hypotheses.size()); ++i)
    for (const double thickness_m : {0.15, 0.3})
      for (int k = 0; k < kDirections; ++k) {
        const Pose& pose = hypotheses[i].fit.map_from_base;
        const double angle = 2.0 * kPi * k / kDirections;
        starts.emplace_back(pose.x_m() + thickness_m * std::cos(angle),
                            pose.y_m() + thickness_m * std::sin(angle), pose.yaw_rad());
      }
  return starts;
}

/// A noisy scan's points lie farther off their walls: the kernel stays wider and more count as inliers.
SegmentIcpOptions forgiving(SegmentIcpOptions icp, double noise_m) {
  icp.last_scale_m = std::max(icp.last_scale_m, 1.5 * noise_m);
  icp.inlier_distance_m = std::max(icp.inlier_distance_m, 2.5 * noise_m);
  return icp;
}

std::vector<Hypothesis> registered(const ScanPoints& points, const std::vector<Pose>& poses,
                                   const SegmentGrid& grid, const SegmentIcpOptions& icp) {
  std::vector<Hypothesis> all;
  for (const Pose& pose : poses) {
    const RegistrationResult fit = segment_icp(points, grid, pose, icp);
    if (fit.map_from_base.is_finite()) all.push_back({fit});
  }
  return all;
}

}  // namespace

std::vector<Hypothesis> refine_poses(const ScanPoints& points, const std::vector<Pose>& poses,
                                     const WallTables& tables) {
  const double noise = scan_noise_m(points);
  const double same_m = std::max(kSamePlaceM, noise);
  const auto weighed = [&](const std::vector<Pose>& starts, const SegmentIcpOptions& icp) {
    std::vector<Hypothesis> all = registered(points, starts, tables.grid, forgiving(icp, noise));
    if (!all.empty()) weigh(points, noise, tables, kThroughWallNats, all);
    return all;
  };
  std::vector<Hypothesis> best = distinct(weighed(poses, near_start()), same_m, kSamePlaceRad);
  SegmentIcpOptions narrow = near_start();
  narrow.first_scale_m = 0.15;
  const std::vector<Hypothesis> beside = weighed(other_faces(best), narrow);
  best.insert(best.end(), beside.begin(), beside.end());
  return distinct(std::move(best), same_m, kSamePlaceRad);
}

}  // namespace madori::localization
