#include "localization/memory/loop_closing.hpp"

#include <algorithm>
#include <cmath>

#include "localization/memory/fuse.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

/// How far the chain may have drifted after so much driving.
SearchWindow window_after(double open_m, const MemoryOptions& options) {
  SearchWindow window;
  window.sigma_m = 0.05 + options.drift_per_m * open_m;
  window.sigma_rad = 0.01 + options.drift_rad_per_m * open_m;
  window.half_m = std::clamp(3.0 * window.sigma_m, 0.2, 3.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.5);
  return window;
}

}  // namespace

std::vector<LoopCandidate> loop_candidates(const std::vector<Transform2<Map, Base>>& poses,
                                           std::size_t newest, std::size_t end,
                                           const MemoryOptions& options) {
  const Transform2<Map, Base>& here = poses[newest];
  const auto away_m = [&](std::size_t i) { return distance_m(poses[i].translation(), here.translation()); };
  std::vector<LoopCandidate> found;
  std::size_t i = 0;
  while (i < end) {  // one candidate per stay in the neighbourhood
    if (away_m(i) > options.loop_radius_m) {
      ++i;
      continue;
    }
    LoopCandidate c{i, i, i, options.loop_radius_m};
    for (; i < end && away_m(i) <= options.loop_radius_m; ++i) {
      const double d = away_m(i) + std::abs(wrap_angle(poses[i].yaw_rad() - here.yaw_rad()));
      if (d < c.distance_m || c.nearest == c.first) {
        c.distance_m = d;
        c.nearest = i;
      }
    }
    const std::size_t half = static_cast<std::size_t>(options.loop_chain) / 2;
    c.first = c.nearest > half ? c.nearest - half : 0;
    c.last = std::min(end - 1, c.nearest + half);
    found.push_back(c);
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.distance_m < b.distance_m; });
  if (found.size() > 2) {
    found.resize(2);  // the nearest two say enough
  }
  return found;
}

std::optional<RelativeFactor> match_loop(const std::vector<Keyframe>& keyframes,
                                         const std::vector<Transform2<Map, Base>>& poses, std::size_t newest,
                                         const LoopCandidate& candidate, double open_m,
                                         const MemoryOptions& options) {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t i = candidate.first; i <= candidate.last; ++i) {
    pieces.push_back({keyframes[i].scan.get(), poses[i]});
  }
  const LocalMap map(pieces, poses[newest].translation(), options.map_radius_m);
  if (map.empty()) {
    return std::nullopt;
  }
  const SurfaceScan& scan = *keyframes[newest].scan;
  const SearchResult coarse = map.search(scan, poses[newest], window_after(open_m, options));
  const MatchResult match = map.refine(scan, coarse.map_from_base, {});
  if (match.inlier_share < options.loop_inliers ||
      distance_m(match.map_from_base.translation(), coarse.map_from_base.translation()) > 0.15) {
    return std::nullopt;
  }
  const Transform2<Map, Base>& old = poses[candidate.nearest];
  RelativeFactor factor;
  factor.from = static_cast<int>(candidate.nearest);
  factor.to = static_cast<int>(newest);
  factor.motion = old.inverse() * match.map_from_base;
  factor.information = in_map_axes(limited(match.information), -old.yaw_rad());
  factor.loop = true;
  return factor;
}

double loops_against(const std::vector<RelativeFactor>& factors,
                     const std::vector<Transform2<Map, Base>>& poses, const Transform2<Map, Map>& by,
                     std::size_t first) {
  constexpr double kLossSq = GraphOptions().loop_loss * GraphOptions().loop_loss;
  const auto nats = [](const RelativeFactor& f, const auto& from, const auto& to) {
    const Eigen::Vector3d e = relative_error(f, from, to);
    return 0.5 * kLossSq * std::log1p(e.dot(f.information * e) / kLossSq);
  };
  double sum = 0.0;
  for (const RelativeFactor& f : factors) {
    const auto from = static_cast<std::size_t>(f.from);
    const auto to = static_cast<std::size_t>(f.to);
    if (!f.loop || (from < first) == (to < first)) continue;
    sum += nats(f, from < first ? poses[from] : by * poses[from], to < first ? poses[to] : by * poses[to]) -
           nats(f, poses[from], poses[to]);
  }
  return sum;
}

}  // namespace madori::localization
