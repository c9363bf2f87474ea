#include "localization/localizer/scan_agreement.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "localization/localizer/pose_covariance.hpp"

namespace madori::localization {
namespace {

/// Is the match far from where the wheels say?
bool jumps(const MatchResult& match, const Transform2<Map, Base>& prediction, const OdometryStep& step) {
  const Transform2<Base, Base> off = prediction.inverse() * match.map_from_base;
  const Eigen::Matrix3d covariance = with_floor(step.covariance);
  const Eigen::Vector3d e(off.x_m(), off.y_m(), off.yaw_rad());
  return e.dot(covariance.inverse() * e) > 16.0;
}

}  // namespace

void ScanAgreement::begin(Stamp stamp) {
  wall_fit_ = WallFit();
  last_agreed_ = stamp;
  doubt_path_m_ = 0.0;
  driven_before_ = false;
}

/// Does the scan lie, where it was matched, on what was remembered until then?
bool ScanAgreement::is_known_from_before(const SurfaceScan& scan, const MatchResult& match,
                                         const MapState& map, double until_path_m,
                                         const LocalizerOptions& options) const {
  const Point2<Map> here = match.map_from_base.translation();
  const LocalMap& before = map.memory.whole_map(here, until_path_m);
  if (before.empty()) return false;
  const MatchResult again = before.refine(scan, match.map_from_base, {});
  return again.inlier_share > std::max(options.lost_inliers, options.known_share * usual_inliers_) &&
         distance_m(again.map_from_base.translation(), here) < options.same_place_m;
}

void ScanAgreement::note(const SurfaceScan& scan, const MatchResult& match,
                         const Transform2<Map, Base>& prediction, const OdometryStep& step, MapState& map,
                         const LocalizerOptions& options) {
  HealthEvidence& evidence = map.evidence;
  const bool drawing_speaks = map.drawing_fits(options);
  const double on_walls =
      drawing_speaks ? map.drawing->walls.standing().share_on_walls(scan, match.map_from_base) : 0.0;
  const bool exact = drawing_speaks && map.drawing_is_exact(options);
  if (drawing_speaks) wall_fit_.add(on_walls, step.path_m, step.turned_rad);
  beside_walls_ = drawing_speaks && on_walls < 0.5 * wall_fit_.usual();
  evidence.on_walls = on_walls;
  evidence.on_memory = match.inlier_share;
  bool agrees = match.inlier_share > std::max(options.lost_inliers, 0.5 * usual_inliers_);
  const auto seen_until = [&](double path_m) {
    return is_known_from_before(scan, match, map, path_m, options);
  };
  // On what was remembered before the doubt began: the vehicle was not carried off, drawn walls or not.
  if (exact && (evidence.blind_scans > 0 || jumps(match, prediction, step)))
    agrees = agrees && (on_walls > 0.5 * wall_fit_.usual() || seen_until(doubt_path_m_));
  const auto& frames = map.memory.keyframes();
  driven_before_ = agrees && wall_fit_.is_poor() && seen_until(frames[map.memory.window_begin()].path_m);
  if (!agrees) {
    ++evidence.blind_scans;
    evidence.blind_m += step.path_m;
    return;
  }
  usual_inliers_ += 0.05 * (match.inlier_share - usual_inliers_);
  last_agreed_ = scan.stamp;
  doubt_path_m_ = map.memory.keyframes().back().path_m;
  evidence.blind_scans = 0;
  evidence.blind_m = 0.0;
}

HealthEvidence ScanAgreement::evidence_at(Stamp stamp, const HealthEvidence& evidence) const {
  HealthEvidence now = evidence;
  if (now.blind_scans > 0) now.blind_s = to_seconds(stamp - last_agreed_);
  now.off_walls = wall_fit_.is_poor() && !driven_before_;
  return now;
}

}  // namespace madori::localization
