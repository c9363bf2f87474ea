#include "localization/slam/scan_follower.hpp"

#include <algorithm>

#include "localization/localizer/scan_matcher.hpp"

namespace madori::localization {

void ScanFollower::on_odometry(const OdometryReading& reading) {
  if (const auto raw = track_.follow(reading)) {
    model_.extend(since_scan_, *raw);
    since_keyframe_.extend(*raw, model_);
  }
}

ScanFollower::Followed ScanFollower::follow(const SurfaceScan& scan, const Transform2<Map, Base>& from,
                                            const MapState& map) {
  Followed followed;
  followed.wheels = track_.between(scan_stamp_, scan.stamp, model_);
  const double enough = std::min(options_.sure_inliers, options_.known_share * usual_inliers_);
  const auto [place, recent] = match_scan(scan, from, followed.wheels, enough, map, options_);
  usual_inliers_ += 0.05 * (place.inlier_share - usual_inliers_);
  followed.place = place;
  followed.found = place.inlier_share > options_.lost_inliers;
  followed.is_known = recent.inlier_share > options_.lost_inliers;
  if (followed.is_known) {
    followed.motion = from.inverse() * recent.map_from_base;
    since_keyframe_.add_matched(followed.motion, recent.information, recent.inlier_share);
    model_.learn(followed.wheels, followed.motion);
  } else {
    followed.motion = followed.found ? from.inverse() * place.map_from_base : followed.wheels.motion;
    since_keyframe_.add_unmatched(followed.motion, recent.inlier_share);
  }
  return followed;
}

void ScanFollower::note_scan(Stamp stamp) {
  scan_stamp_ = stamp;
  since_scan_ = track_.since(stamp, model_);
}

}  // namespace madori::localization
