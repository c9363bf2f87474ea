#include "localization/slam/final_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/memory/fuse.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/pose_axes.hpp"
#include "localization/slam/surface_bundle.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

constexpr double kWholeScanM = 40.0;
constexpr double kPartnersNearM = 5.0;  // keyframes this near to each other may have seen the same surfaces,
constexpr double kPartnersRadianM = 0.7;  // a radian of turn counting as so much,
constexpr std::size_t kPartners = 20;     // at most so many of them, from near to far
constexpr double kLastInliers = 0.4;      // of a scan that must lie on what it is laid on
constexpr double kOfChain = 0.05;         // what the drive's motions count where partners hold a keyframe
constexpr double kLoopLoss = 1.0;         // sigmas; beyond, a tie pulls less and less (Cauchy)
constexpr int kLastRounds = 3;
constexpr double kPieceNearM = 4.0;  // keyframes this near make the piece of map that a scan is laid on,
constexpr double kPieceRadianM = 1.0;
constexpr std::size_t kPieceKeyframes = 15;  // at most so many
constexpr double kScanSigmaM = 0.05;         // of a scan's pose between its keyframes
constexpr double kScanSigmaRad = 0.016;

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
std::vector<std::vector<std::size_t>> partners(const std::vector<Pose>& poses) {
  std::vector<std::vector<std::size_t>> newer(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::vector<std::size_t> near = near_poses(poses, i, poses[i], kPartnersNearM, kPartnersRadianM);
    const std::size_t kept = std::min(near.size(), kPartners);
    for (std::size_t k = 0; k < kept; ++k) newer[near[k * near.size() / kept]].push_back(i);
  }
  return newer;
}

std::optional<RelativeFactor> tie(const LocalMap& map, const Memory& memory, const std::vector<Pose>& poses,
                                  std::size_t older, std::size_t newer, MatchStart start) {
  const MatchResult match = map.refine(*memory.keyframes()[newer].scan, poses[newer], {}, {}, start);
  if (!match.converged || match.inlier_share < kLastInliers) return std::nullopt;
  return RelativeFactor{static_cast<int>(older), static_cast<int>(newer),
                        poses[older].inverse() * match.map_from_base,
                        in_map_axes(limited(match.information), -poses[older].yaw_rad()), true};
}

void add_ties(const Memory& memory, const std::vector<Pose>& poses, MatchStart start,
              std::vector<RelativeFactor>& factors) {
  const auto newer = partners(poses);
  for (std::size_t j = 0; j < poses.size(); ++j) {
    if (newer[j].empty()) continue;
    const LocalMap map({{memory.keyframes()[j].scan.get(), poses[j]}}, poses[j].translation(), kWholeScanM);
    for (const std::size_t i : newer[j])
      if (const auto found = tie(map, memory, poses, j, i, start)) factors.push_back(*found);
  }
}

LocalMap map_around(const Memory& memory, const Pose& here) {
  std::vector<LocalMap::Piece> pieces;
  for (const std::size_t k : near_poses(memory.poses(), memory.size(), here, kPieceNearM, kPieceRadianM)) {
    if (pieces.size() == kPieceKeyframes) break;
    pieces.push_back({memory.keyframes()[k].scan.get(), memory.poses()[k]});
  }
  return {pieces, here.translation(), kWholeScanM};
}

}  // namespace

Memory final_fit(const Memory& memory, const MemoryOptions& memory_options) {
  std::vector<Pose> poses = memory.poses();
  std::vector<RelativeFactor> drive = memory.factors();
  for (RelativeFactor& f : drive)
    if (!f.loop) f.information *= kOfChain;
  GraphOptions graph;
  graph.max_iterations = 20;
  graph.loop_loss = kLoopLoss;
  std::vector<RelativeFactor> factors;
  for (int round = 0; round < kLastRounds; ++round) {
    factors = drive;
    add_ties(memory, poses, round == 0 ? MatchStart::Rough : MatchStart::Near, factors);
    if (!optimise_graph(poses, factors, {}, graph)) break;
  }
  return {memory_options, memory.keyframes(), std::move(poses), std::move(factors), memory.loops()};
}

void fit_scans(const Memory& memory, const std::vector<std::size_t>& scan_of,
               const std::vector<std::shared_ptr<const SurfaceScan>>& scans, std::vector<MomentPose>& poses) {
  const double m2 = kScanSigmaM * kScanSigmaM;
  const double rad2 = kScanSigmaRad * kScanSigmaRad;
  const Eigen::Matrix3d information = Eigen::Vector3d(1.0 / m2, 1.0 / m2, 1.0 / rad2).asDiagonal();
  for (std::size_t k = 0; k < scan_of.size(); ++k) {
    const std::size_t end = k + 1 < scan_of.size() ? scan_of[k + 1] : poses.size();
    if (scan_of[k] + 1 >= end) continue;
    const LocalMap map = map_around(memory, memory.poses()[k]);
    for (std::size_t i = scan_of[k] + 1; i < end; ++i) {
      Pose& pose = poses[i].map_from_base;
      const MatchResult match = map.refine(*scans[i], pose, {pose, information}, {}, MatchStart::Near);
      if (match.converged && match.inlier_share > kLastInliers) pose = match.map_from_base;
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
