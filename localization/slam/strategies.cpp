#include "localization/slam/strategies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_set>
#include <utility>

#include "localization/pose_axes.hpp"
#include "localization/registration/cpd.hpp"
#include "localization/slam/range_ring.hpp"

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

bool succeeded(const RegistrationResult& fit, const StrategyOptions& options) {
  return fit.e_psr_m < options.most_e_psr_m && fit.near_fraction >= options.least_near;
}

std::optional<StrategyResult> refined(const ScanPoints& scan, const PointMap& map, const Pose& rough,
                                      Strategy strategy, const StrategyOptions& options) {
  const RegistrationResult fit = point_icp(scan, map, rough, options.icp);
  return succeeded(fit, options) ? std::optional(StrategyResult{fit, strategy}) : std::nullopt;
}

/// The best of them at different places: many candidates lead to the same one.
std::vector<RegistrationResult> distinct(const std::vector<RegistrationResult>& fits, std::size_t most) {
  constexpr double kSameM = 0.15;
  constexpr double kSameRad = 0.05;
  std::vector<RegistrationResult> kept;
  for (const RegistrationResult& fit : fits) {
    if (kept.size() == most) break;
    const Pose& at = fit.map_from_base;
    if (std::none_of(kept.begin(), kept.end(), [&](const RegistrationResult& k) {
          return same_place(k.map_from_base, at, kSameM, kSameRad);
        }))
      kept.push_back(fit);
  }
  return kept;
}

/// ICP of all candidates with few steps and points, and of the best of them to the end.
std::vector<RegistrationResult> refined_exactly(const ScanPoints& scan, const PointMap& map,
                                                std::span<const RdnmResult> candidates,
                                                const StrategyOptions& options) {
  const auto worth = [](const RegistrationResult& fit) { return fit.near_fraction / (0.01 + fit.e_psr_m); };
  PointIcpOptions exact = options.icp;
  exact.prior_information.setZero();
  PointIcpOptions rough = exact;
  rough.max_iterations = options.rough_iterations;
  rough.coarse_points = options.rough_points;
  std::vector<RegistrationResult> fits;
  for (const RdnmResult& candidate : candidates)
    fits.push_back(point_icp(scan, map, candidate.map_from_base, rough));
  std::stable_sort(fits.begin(), fits.end(),
                   [&](const auto& a, const auto& b) { return worth(a) > worth(b); });
  fits = distinct(fits, options.refined_exactly);
  for (RegistrationResult& fit : fits) fit = point_icp(scan, map, fit.map_from_base, exact);
  return fits;
}

}  // namespace

StrategyOptions with_noise(StrategyOptions options, double noise_m) {
  // What noise alone costs a point in the mean, where it is all that keeps the point from its surface: the
  // mean of log(0.1 + 0.9 exp(-z²/2)) over a standard normal z (LikelihoodOptions).
  constexpr double kScatteredNats = 0.40;
  options.icp.last_scale_m = std::max(options.icp.last_scale_m, 1.5 * noise_m);
  options.icp.inlier_distance_m = std::max(options.icp.inlier_distance_m, noise_m);
  const double scatter_m = std::max(options.likelihood.sigma_m, noise_m);
  options.enough_a_point -= kScatteredNats * (1.0 - std::pow(options.likelihood.sigma_m / scatter_m, 2.0));
  options.likelihood.sigma_m = scatter_m;
  // Of the map's point and of the beam's end alike.
  options.likelihood.margin_m = std::max(options.likelihood.margin_m, 3.0 * std::sqrt(2.0) * noise_m);
  return options;
}

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

GlobalViews::GlobalViews(const PointMap& map, const StrategyOptions& options) {
  constexpr double kBlockM = 5.0;  // the candidates of a block share the points they see
  const std::vector<Point2<Map>> points = thinned(map.points(), options.view_spacing_m);
  std::map<std::pair<int, int>, std::vector<Point2<Map>>> blocks;
  for (const Point2<Map>& p : global_candidates(map, options.grid_m, options.clearance_m))
    blocks[{static_cast<int>(std::floor(p.x_m / kBlockM)), static_cast<int>(std::floor(p.y_m / kBlockM))}]
        .push_back(p);
  for (const auto& [at, candidates] : blocks) {
    const Point2<Map> centre{(at.first + 0.5) * kBlockM, (at.second + 0.5) * kBlockM};
    const auto around = points_around(points, centre, options.global_view_m + 0.5 * kBlockM);
    for (const Point2<Map>& candidate : candidates) {
      places_.push_back(candidate);
      views_.push_back(rdn<Map>(around, candidate, options.rdn));
    }
  }
}

std::vector<RdnmResult> GlobalViews::ranked(const ScanPoints& scan, const RdnOptions& options) const {
  return rdnm_ranked(scan, places_, views_, options);
}

namespace {

/// What the points say: how far each lies from the surface that the map's points around it make.
double log_of_hits(const ScanPoints& scan, const PointMap& map, const Pose& pose,
                   const LikelihoodOptions& options) {
  double sum = 0.0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Point2<Map> p = pose * scan.point(i);
    const PointMap::Neighbour nearest = map.nearest(p);
    // In a cloud that noise made thick some point is always near: what tells is how far its surface is.
    const PointSurface& surface = map.surface(nearest.index);
    const double across = (p.x_m - surface.x_m) * surface.normal_x + (p.y_m - surface.y_m) * surface.normal_y;
    const double squared = std::max(nearest.squared_distance_m2, surface.flatness * across * across);
    const double hit = std::exp(-0.5 * squared / (options.sigma_m * options.sigma_m));
    sum += std::log(options.other + (1.0 - options.other) * hit);
  }
  return sum;
}

/// Whether no point of the scan lies so near: a beam that grazes a wall ends far behind points of it.
bool is_clear_of(const ScanPoints& scan, const Point2<Base>& p, double margin_m) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double dx = scan.x_m[i] - p.x_m, dy = scan.y_m[i] - p.y_m;
    if (dx * dx + dy * dy < margin_m * margin_m) return false;
  }
  return true;
}

/// In how many directions of the ring beams pass a point of the map by.
std::size_t directions_through(const ScanPoints& scan, const PointMap& map, const Pose& pose,
                               const LikelihoodOptions& options) {
  const RangeRing ring(scan, options.sensor);
  std::vector<bool> passed(RangeRing::kSize, false);
  const Transform2<Base, Map> base_from_map = pose.inverse();
  for (const Point2<Map>& p : map.points()) {
    std::size_t direction = 0;
    if (distance_m(p, pose.translation()) >= options.view_m) continue;
    const Point2<Base> seen = base_from_map * p;
    if (ring.passes(seen, options.margin_m, direction) && !passed[direction])
      passed[direction] = is_clear_of(scan, seen, options.margin_m);
  }
  return static_cast<std::size_t>(std::count(passed.begin(), passed.end(), true));
}

/// In how many beams end at a point of the map.
std::size_t directions_met(const ScanPoints& scan, const PointMap& map, const Pose& pose,
                           const LikelihoodOptions& options) {
  std::vector<bool> met(RangeRing::kSize, false);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Point2<Base> p = scan.point(i);
    if (map.nearest(pose * p).squared_distance_m2 < options.margin_m * options.margin_m)
      met[RangeRing::index(std::atan2(p.y_m - options.sensor.y_m, p.x_m - options.sensor.x_m))] = true;
  }
  return static_cast<std::size_t>(std::count(met.begin(), met.end(), true));
}

}  // namespace

double log_likelihood(const ScanPoints& scan, const PointMap& map, const Pose& pose,
                      const LikelihoodOptions& options) {
  const auto directions = static_cast<double>(directions_through(scan, map, pose, options));
  const double beams = directions / RangeRing::kSize * static_cast<double>(scan.size()) * options.turn_share;
  return log_of_hits(scan, map, pose, options) + beams * std::log(options.other);
}

double contradiction(const ScanPoints& scan, const PointMap& map, const Pose& pose,
                     const LikelihoodOptions& options) {
  const auto through = static_cast<double>(directions_through(scan, map, pose, options));
  const auto met = static_cast<double>(directions_met(scan, map, pose, options));
  return through > 0.0 ? through / (through + met) : 0.0;
}

std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan, const PointMap& map,
                                                  const GlobalViews& views, const StrategyOptions& options) {
  RdnOptions by = options.rdn;
  by.norm = options.global_norm;
  const std::vector<RdnmResult> ranked = views.ranked(scan, by);
  const double enough = options.enough_a_point * static_cast<double>(scan.size());
  std::optional<StrategyResult> best;
  double most = -INFINITY;
  for (std::size_t i = 0; i < std::min(ranked.size(), options.most_refined) && most < enough;
       i += options.refined)
    for (const RegistrationResult& fit : refined_exactly(
             scan, map, std::span(ranked).subspan(i).first(std::min(options.refined, ranked.size() - i)),
             options)) {
      const double likelihood = log_likelihood(scan, map, fit.map_from_base, options.likelihood);
      if (!succeeded(fit, options) || likelihood <= most) continue;
      most = likelihood;
      best = StrategyResult{fit, Strategy::Absolute};
    }
  return best;
}

std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan, const PointMap& map,
                                                  const StrategyOptions& options) {
  return localize_absolutely(scan, map, GlobalViews(map, options), options);
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
