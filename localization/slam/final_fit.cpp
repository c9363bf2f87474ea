#include "localization/slam/final_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/memory/fuse.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/slam/surface_bundle.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

constexpr double kWholeScanM = 40.0;

/// Those of the first `end` poses that are near `here`, nearest first.
std::vector<std::size_t> near_poses(const std::vector<Pose>& poses, std::size_t end, const Pose& here,
                                    double near_m, double radian_m) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t k = 0; k < end; ++k) {
    const double d = distance_m(poses[k].translation(), here.translation()) +
                     radian_m * std::abs(wrap_angle(poses[k].yaw_rad() - here.yaw_rad()));
    if (d < near_m) near.emplace_back(d, k);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> found;
  for (const auto& [d, k] : near) found.push_back(k);
  return found;
}

/// For every keyframe the newer ones to lay on it. Of many partners those at even steps from near to far: far
/// ones tell more of the map's shape.
std::vector<std::vector<std::size_t>> partners(const std::vector<Pose>& poses,
                                               const FinalFitOptions& options) {
  std::vector<std::vector<std::size_t>> newer(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::vector<std::size_t> near = near_poses(poses, i, poses[i], options.near_m, options.radian_m);
    const std::size_t kept = std::min(near.size(), options.partners);
    for (std::size_t k = 0; k < kept; ++k) newer[near[k * near.size() / kept]].push_back(i);
  }
  return newer;
}

std::optional<RelativeFactor> tie(const LocalMap& map, const Memory& memory, const std::vector<Pose>& poses,
                                  std::size_t older, std::size_t newer, MatchStart start,
                                  const FinalFitOptions& options) {
  const MatchResult match = map.refine(*memory.keyframes()[newer].scan, poses[newer], {}, {}, start);
  if (!match.converged || match.inlier_share < options.inlier_share) return std::nullopt;
  return RelativeFactor{static_cast<int>(older), static_cast<int>(newer),
                        poses[older].inverse() * match.map_from_base,
                        in_map_axes(limited(match.information), -poses[older].yaw_rad()), true};
}

void add_ties(const Memory& memory, const std::vector<Pose>& poses, MatchStart start,
              const FinalFitOptions& options, std::vector<RelativeFactor>& factors) {
  const auto newer = partners(poses, options);
  for (std::size_t j = 0; j < poses.size(); ++j) {
    if (newer[j].empty()) continue;
    const LocalMap map({{memory.keyframes()[j].scan.get(), poses[j]}}, poses[j].translation(), kWholeScanM);
    for (const std::size_t i : newer[j])
      if (const auto found = tie(map, memory, poses, j, i, start, options)) factors.push_back(*found);
  }
}

LocalMap map_around(const Memory& memory, const Pose& here, const FinalFitOptions& options) {
  std::vector<LocalMap::Piece> pieces;
  for (const std::size_t k :
       near_poses(memory.poses(), memory.size(), here, options.map_near_m, options.map_radian_m)) {
    if (pieces.size() == options.map_keyframes) break;
    pieces.push_back({memory.keyframes()[k].scan.get(), memory.poses()[k]});
  }
  return {pieces, here.translation(), kWholeScanM};
}

}  // namespace

Memory final_fit(const Memory& memory, const MemoryOptions& memory_options, const FinalFitOptions& options) {
  std::vector<Pose> poses = memory.poses();
  std::vector<RelativeFactor> drive = memory.factors();
  for (RelativeFactor& f : drive)
    if (!f.loop) f.information *= options.chain_information;
  GraphOptions graph;
  graph.max_iterations = 20;
  graph.loop_loss = options.loop_loss;
  std::vector<RelativeFactor> factors;
  for (int round = 0; round < options.rounds; ++round) {
    factors = drive;
    add_ties(memory, poses, round == 0 ? MatchStart::Rough : MatchStart::Near, options, factors);
    if (!optimise_graph(poses, factors, {}, graph)) break;
  }
  return {memory_options, memory.keyframes(), std::move(poses), std::move(factors), memory.loops()};
}

void fit_scans(const Memory& memory, const std::vector<std::size_t>& scan_of,
               const std::vector<std::shared_ptr<const SurfaceScan>>& scans, std::vector<MomentPose>& poses,
               const FinalFitOptions& options) {
  const double m2 = options.scan_sigma_m * options.scan_sigma_m;
  const double rad2 = options.scan_sigma_rad * options.scan_sigma_rad;
  const Eigen::Matrix3d information = Eigen::Vector3d(1.0 / m2, 1.0 / m2, 1.0 / rad2).asDiagonal();
  for (std::size_t k = 0; k < scan_of.size(); ++k) {
    const std::size_t end = k + 1 < scan_of.size() ? scan_of[k + 1] : poses.size();
    if (scan_of[k] + 1 >= end) continue;
    const LocalMap map = map_around(memory, memory.poses()[k], options);
    for (std::size_t i = scan_of[k] + 1; i < end; ++i) {
      Pose& pose = poses[i].map_from_base;
      const MatchResult match = map.refine(*scans[i], pose, {pose, information}, {}, MatchStart::Near);
      if (match.converged && match.inlier_share > options.inlier_share) pose = match.map_from_base;
    }
  }
}

Memory bundle_noisy(const Memory& memory, const std::vector<std::size_t>& scan_of,
                    const std::vector<std::shared_ptr<const SurfaceScan>>& scans, double noise_m,
                    const MemoryOptions& memory_options, std::vector<MomentPose>& poses) {
  const Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / (noise_m * noise_m);
  std::vector<ScanPoints> points(scans.size());
  std::vector<Pose> at;
  std::vector<RelativeFactor> motions;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (const SurfacePoint& p : scans[i]->points) points[i].add(p.x_m, p.y_m);
    at.push_back(poses[i].map_from_base);
    const auto n = static_cast<int>(i);
    if (i > 0) motions.push_back({n - 1, n, at[i - 1].inverse() * at[i], information});
  }
  at = bundle_scans(points, std::move(at), motions, noise_m);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].map_from_base = at[i];
  std::vector<Pose> keyframes;
  for (const std::size_t scan : scan_of) keyframes.push_back(at[scan]);
  return {memory_options, memory.keyframes(), std::move(keyframes), memory.factors(), memory.loops()};
}

}  // namespace madori::localization
