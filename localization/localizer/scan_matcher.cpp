#include "localization/localizer/scan_matcher.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

MatchResult search_and_refine(const LocalMap& map, const SurfaceScan& scan, const SearchWindow& window,
                              const MatchPrior& prior, const ExtraPull& pull) {
  return map.refine(scan, map.search(scan, prior.map_from_base, window).map_from_base, prior, pull);
}

SearchWindow near_window(const Eigen::Matrix3d& covariance, double path_m) {
  SearchWindow window;
  window.sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
  window.sigma_rad = std::sqrt(covariance(2, 2));
  window.half_m = std::clamp(3.0 * window.sigma_m, std::min(0.3, 0.15 + 2.0 * path_m), 1.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.8);
  return window;
}

SearchWindow far_window(SearchWindow window, double path_m) {
  window.half_m = 0.5 + 0.5 * std::min(2.0, path_m);
  window.half_rad = 0.8;
  return window;
}

ExtraPull drawing_pull(const SurfaceScan& scan, const MapState& map, const LocalizerOptions& options) {
  if (!map.drawing_is_exact(options)) return {};
  return [&scan, &drawing = map.drawing->walls.standing()](const Pose& pose, Eigen::Matrix3d& hessian,
                                                           Eigen::Vector3d& gradient) {
    drawing.pull(scan, pose, hessian, gradient);
  };
}

/// By how much more of the scan a far match must explain: the farther from what the wheels say, the clearer
/// the scan must speak.
double far_margin(const Pose& prediction, const Pose& far, const SearchWindow& window) {
  const Transform2<Base, Base> off = prediction.inverse() * far;
  const double metres = std::hypot(off.x_m(), off.y_m()) / window.sigma_m;
  const double turns = off.yaw_rad() / window.sigma_rad;
  return 0.05 + 0.03 * std::log1p(metres * metres + turns * turns);
}

}  // namespace

ScanMatch match_scan(const SurfaceScan& scan, const Pose& from, const OdometryStep& step, double enough,
                     const MapState& map, const LocalizerOptions& options) {
  const Pose prediction = from * step.motion;
  const Point2<Map> here = prediction.translation();
  const Eigen::Matrix3d covariance = with_floor(in_map_axes(step.covariance, from.yaw_rad()));
  const MatchPrior prior{prediction, covariance.inverse()};
  const SearchWindow window = near_window(covariance, step.path_m);
  const ExtraPull pull = drawing_pull(scan, map, options);
  const LocalMap& recent = map.memory.recent_map(here);
  if (window.sigma_m < options.sure_step_m && window.sigma_rad < options.sure_step_rad) {
    const MatchResult at_once = recent.refine(scan, prediction, prior, pull, MatchStart::Near);
    if (at_once.inlier_share > enough) return {at_once, at_once};
  }
  const MatchResult near = search_and_refine(recent, scan, window, prior, pull);
  if (near.inlier_share > enough) return {near, near};
  const MatchResult far =
      search_and_refine(map.memory.whole_map(here), scan, far_window(window, step.path_m), prior, pull);
  const double margin = far_margin(prediction, far.map_from_base, window);
  return {far.inlier_share > near.inlier_share + margin ? far : near, near};
}

std::optional<Pose> place_in_memory(const SurfaceScan& scan, const MapState& map,
                                    const LocalizerOptions& options) {
  const StartPrior start = *map.start;  // recalled only where a start was given
  const LocalMap& whole = map.memory.whole_map(start.map_from_base.translation());
  const SearchWindow window{2.0 * start.sigma_m, 2.0 * start.sigma_rad, start.sigma_m, start.sigma_rad};
  const MatchResult found =
      whole.refine(scan, whole.search(scan, start.map_from_base, window).map_from_base, {});
  return found.inlier_share > options.sure_inliers ? std::optional(found.map_from_base) : std::nullopt;
}

}  // namespace madori::localization
