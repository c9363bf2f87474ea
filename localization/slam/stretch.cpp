#include "localization/slam/stretch.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/memory/fuse.hpp"
#include "localization/memory/local_map.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// A frame of its own: the middle keyframe of the older stretch is its origin.
Pose as_pose(const Transform2<Base, Base>& motion) {
  return {motion.x_m(), motion.y_m(), motion.yaw_rad()};
}

Transform2<Base, Base> as_motion(const Pose& pose) {
  return {pose.x_m(), pose.y_m(), pose.yaw_rad()};
}

/// What the keyframes of a stretch saw around the guess, axes of its middle keyframe.
LocalMap stretch_map(const Memory& memory, const Stretch& from, const Transform2<Base, Base>& guess,
                     const StretchOptions& options) {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t k = from.first; k <= from.last; ++k)
    pieces.push_back({memory.keyframes()[k].scan.get(),
                      as_pose(memory.poses()[from.middle].inverse() * memory.poses()[k])});
  return {pieces, as_pose(guess).translation(), options.map_radius_m};
}

std::int64_t cell_of(const SurfacePoint& p, double side_m) {
  const auto ix = static_cast<std::int64_t>(std::floor(p.x_m / side_m));
  const auto iy = static_cast<std::int64_t>(std::floor(p.y_m / side_m));
  return (ix << 32) ^ (iy & 0xFFFFFFFF);
}

std::vector<std::size_t> evenly(const Stretch& stretch, std::size_t most) {
  const std::size_t n = stretch.last - stretch.first + 1;
  const std::size_t kept = std::min(n, most);
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < kept; ++k)
    some.push_back(stretch.first + (kept > 1 ? k * (n - 1) / (kept - 1) : stretch.middle - stretch.first));
  return some;
}

}  // namespace

Stretch stretch_around(const std::vector<Keyframe>& keyframes, std::size_t middle,
                       const StretchOptions& options) {
  Stretch s{middle, middle, middle};
  const auto belongs = [&](std::size_t k, std::size_t away) {
    const double path_m = std::abs(keyframes[k].path_m - keyframes[middle].path_m);
    return away <= options.least_keyframes ||
           (away <= options.half_keyframes && path_m <= options.half_path_m);
  };
  while (s.first > 0 && !keyframes[s.first].cut && belongs(s.first - 1, middle - s.first + 1)) --s.first;
  while (s.last + 1 < keyframes.size() && !keyframes[s.last + 1].cut &&
         belongs(s.last + 1, s.last + 1 - middle))
    ++s.last;
  return s;
}

SurfaceScan stretch_scan(const Memory& memory, const Stretch& stretch, double spacing_m) {
  SurfaceScan all;
  all.stamp = memory.keyframes()[stretch.middle].scan->stamp;
  std::unordered_set<std::int64_t> taken;
  for (std::size_t k = stretch.first; k <= stretch.last; ++k) {
    const auto by = memory.poses()[stretch.middle].inverse() * memory.poses()[k];
    for (const SurfacePoint& p : memory.keyframes()[k].scan->points) {
      const Point2<Base> q = by * Point2<Base>{p.x_m, p.y_m};
      const SurfacePoint moved{q.x_m, q.y_m, by.cos_yaw() * p.normal_x - by.sin_yaw() * p.normal_y,
                               by.sin_yaw() * p.normal_x + by.cos_yaw() * p.normal_y};
      if (taken.insert(cell_of(moved, spacing_m)).second) all.points.push_back(moved);
    }
  }
  return all;
}

SightCount stretch_sights(const Memory& memory, const Stretch& from, const Stretch& to,
                          const Transform2<Base, Base>& motion, std::size_t witnesses) {
  SightCount sum;
  const auto& keyframes = memory.keyframes();
  const auto& poses = memory.poses();
  std::vector<SightRing> rings;
  const std::vector<std::size_t> theirs = evenly(to, witnesses);
  rings.reserve(theirs.size());
  for (const std::size_t j : theirs) rings.emplace_back(*keyframes[j].scan);
  for (const std::size_t i : evenly(from, witnesses)) {
    const SightRing ring(*keyframes[i].scan);
    const auto i_from_middle = poses[i].inverse() * poses[from.middle];
    for (std::size_t k = 0; k < theirs.size(); ++k) {
      const auto j_from_i = i_from_middle * motion * (poses[to.middle].inverse() * poses[theirs[k]]);
      sum += ring.of(*keyframes[theirs[k]].scan, j_from_i);
      sum += rings[k].of(*keyframes[i].scan, j_from_i.inverse());
    }
  }
  return sum;
}

bool is_seen_alike(const Memory& memory, const RelativeFactor& loop, double most_through,
                   const StretchOptions& options) {
  const auto& keyframes = memory.keyframes();
  const Stretch from = stretch_around(keyframes, static_cast<std::size_t>(loop.from), options);
  const Stretch to = stretch_around(keyframes, static_cast<std::size_t>(loop.to), options);
  return stretch_sights(memory, from, to, loop.motion, options.witnesses).contradiction() <= most_through;
}

StretchMatch lean_stretches(const Memory& memory, const Stretch& from, const Stretch& to,
                            const Transform2<Base, Base>& guess, const Eigen::Matrix3d& covariance,
                            const StretchOptions& options) {
  const LocalMap map = stretch_map(memory, from, guess, options);
  const double sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
  const double sigma_rad = std::sqrt(covariance(2, 2));
  const SearchWindow window{std::min(3.0 * sigma_m, options.search_m),
                            std::min(3.0 * sigma_rad, options.search_rad), sigma_m, sigma_rad};
  const SurfaceScan scan = stretch_scan(memory, to, options.spacing_m);
  const MatchPrior prior{as_pose(guess), covariance.inverse()};
  Pose pose = as_pose(guess);
  MatchResult match;
  if (!map.empty()) {
    match = map.refine(scan, map.search(scan, pose, window).map_from_base, prior);
    pose = match.map_from_base;
  }
  const Transform2<Base, Base> motion = as_motion(pose);
  return {{static_cast<int>(from.middle), static_cast<int>(to.middle), motion,
           limited(match.information + prior.information), false},
          stretch_sights(memory, from, to, motion, options.witnesses),
          match.inlier_share};
}

std::optional<StretchMatch> match_stretches(const Memory& memory, const Stretch& from, const Stretch& to,
                                            const Transform2<Base, Base>& guess,
                                            const StretchOptions& options) {
  const LocalMap map = stretch_map(memory, from, guess, options);
  if (map.empty()) return std::nullopt;
  const SurfaceScan scan = stretch_scan(memory, to, options.spacing_m);
  const SearchWindow window{options.search_m, options.search_rad, options.search_m, options.search_rad};
  const SearchResult coarse = map.search(scan, as_pose(guess), window);
  const MatchResult match = map.refine(scan, coarse.map_from_base, {});
  if (!match.converged || match.inlier_share < options.least_inliers) return std::nullopt;
  const Transform2<Base, Base> motion = as_motion(match.map_from_base);
  const Eigen::Matrix3d information = limited(match.information);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(information, Eigen::EigenvaluesOnly);
  if (directions.eigenvalues()[0] < options.least_information) return std::nullopt;
  const SightCount sights = stretch_sights(memory, from, to, motion, options.witnesses);
  if (sights.both() < options.least_seen || sights.contradiction() > options.most_through)
    return std::nullopt;
  return StretchMatch{{static_cast<int>(from.middle), static_cast<int>(to.middle), motion, information, true},
                      sights,
                      match.inlier_share};
}

}  // namespace madori::localization
