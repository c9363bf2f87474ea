#include "localization/slam/strategies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_set>
#include <utility>

#include "localization/registration/cpd.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

std::vector<Point2<Map>> points_around(const std::vector<Point2<Map>>& points, const Point2<Map>& centre,
                                       double radius_m) {
  std::vector<Point2<Map>> around;
  for (const Point2<Map>& p : points)
    if (distance_m(p, centre) < radius_m) around.push_back(p);
  return around;
}

/// One point of each square of the given side.
std::vector<Point2<Map>> thinned(const std::vector<Point2<Map>>& points, double side_m) {
  std::unordered_set<std::int64_t> taken;
  std::vector<Point2<Map>> some;
  for (const Point2<Map>& p : points) {
    const auto ix = static_cast<std::int64_t>(std::floor(p.x_m / side_m));
    const auto iy = static_cast<std::int64_t>(std::floor(p.y_m / side_m));
    if (taken.insert((ix << 32) ^ (iy & 0xFFFFFFFF)).second) some.push_back(p);
  }
  return some;
}

/// Among the assumed position and six around it, and turns within 45 degrees, the pose that RDNM likes best.
Pose locally_likeliest(const ScanPoints& scan, const PointMap& map, const Pose& assumed,
                       const StrategyOptions& options) {
  std::vector<Point2<Map>> candidates{assumed.translation()};
  for (int i = 0; i < 6; ++i) {
    const double angle = i * kPi / 3.0;
    candidates.push_back({assumed.x_m() + options.candidate_radius_m * std::cos(angle),
                          assumed.y_m() + options.candidate_radius_m * std::sin(angle)});
  }
  const auto around = points_around(map.points(), assumed.translation(), options.view_radius_m);
  const auto found = rdnm(scan, around, candidates, options.rdn, {assumed.yaw_rad(), options.most_turn_rad});
  return found ? found->map_from_base : assumed;
}

/// Algorithm 1 over all candidates, most like the scan first; those of a block share the points they see.
std::vector<RdnmResult> globally_likeliest(const ScanPoints& scan, const PointMap& map,
                                           const StrategyOptions& options) {
  constexpr double kBlockM = 5.0;
  const std::vector<Point2<Map>> points = thinned(map.points(), options.view_spacing_m);
  std::map<std::pair<int, int>, std::vector<Point2<Map>>> blocks;
  for (const Point2<Map>& p : global_candidates(map, options.grid_m, options.clearance_m))
    blocks[{static_cast<int>(std::floor(p.x_m / kBlockM)), static_cast<int>(std::floor(p.y_m / kBlockM))}]
        .push_back(p);
  std::vector<RdnmResult> all;
  for (const auto& [at, candidates] : blocks) {
    const Point2<Map> centre{(at.first + 0.5) * kBlockM, (at.second + 0.5) * kBlockM};
    const auto around = points_around(points, centre, options.global_view_m + 0.5 * kBlockM);
    const auto ranked = rdnm_ranked(scan, around, candidates, options.rdn);
    all.insert(all.end(), ranked.begin(), ranked.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.difference_m < b.difference_m; });
  return all;
}

bool succeeded(const RegistrationResult& fit, const StrategyOptions& options) {
  return fit.e_psr_m < options.most_e_psr_m && fit.near_fraction >= options.least_near;
}

std::optional<StrategyResult> refined(const ScanPoints& scan, const PointMap& map, const Pose& rough,
                                      Strategy strategy, const StrategyOptions& options) {
  const RegistrationResult fit = point_icp(scan, map, rough, options.icp);
  return succeeded(fit, options) ? std::optional(StrategyResult{fit, strategy}) : std::nullopt;
}

}  // namespace

const char* to_string(Strategy strategy) {
  switch (strategy) {
    case Strategy::Rdnm:
      return "RDNM";
    case Strategy::Cpd:
      return "CPD";
    case Strategy::Absolute:
      return "absolute";
  }
  return "";
}

std::vector<Point2<Map>> global_candidates(const PointMap& map, double grid_m, double clearance_m) {
  std::vector<Point2<Map>> candidates;
  if (map.empty()) return candidates;
  Point2<Map> low = map.points().front();
  Point2<Map> high = low;
  for (const Point2<Map>& p : map.points()) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  for (double y = low.y_m + 0.5 * grid_m; y < high.y_m; y += grid_m)
    for (double x = low.x_m + 0.5 * grid_m; x < high.x_m; x += grid_m)
      if (map.nearest({x, y}).squared_distance_m2 > clearance_m * clearance_m) candidates.push_back({x, y});
  return candidates;
}

std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan, const PointMap& map,
                                                  const StrategyOptions& options) {
  const std::vector<RdnmResult> ranked = globally_likeliest(scan, map, options);
  StrategyOptions alone = options;
  alone.icp.prior_information.setZero();
  const auto worth = [](const StrategyResult& r) { return r.fit.near_fraction / (0.01 + r.fit.e_psr_m); };
  std::optional<StrategyResult> best;
  for (std::size_t i = 0; i < std::min(options.refined, ranked.size()); ++i) {
    const auto found = refined(scan, map, ranked[i].map_from_base, Strategy::Absolute, alone);
    if (found && (!best || worth(*found) > worth(*best))) best = found;
  }
  return best;
}

std::optional<StrategyResult> localize_around(const ScanPoints& scan, const PointMap& map,
                                              const Pose& assumed, const StrategyOptions& options) {
  if (map.empty()) return std::nullopt;
  StrategyOptions expected = options;
  expected.most_e_psr_m = options.most_e_psr_expected_m;
  expected.least_near = options.least_near_expected;
  const Pose near = locally_likeliest(scan, map, assumed, options);
  if (const auto found = refined(scan, map, near, Strategy::Rdnm, expected)) return found;
  const Pose drifted = cpd(scan, map, assumed).map_from_base;
  return refined(scan, map, drifted, Strategy::Cpd, expected);
}

}  // namespace madori::localization
