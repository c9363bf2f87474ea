#include "localization/wall_tracker/tracker_evidence.hpp"

#include <cmath>

#include "localization/particle_filter/beam_path.hpp"

namespace madori::localization {

TrackerEvidence evidence_of(const ScanPoints& points, const RegistrationResult& fit,
                            const Transform2<Map, Base>& predicted, const GlobalLocalizer& global) {
  const Transform2<Map, Base>& there = fit.map_from_base;
  TrackerEvidence evidence;
  evidence.explained = fit.inlier_fraction;
  evidence.through_walls = share_through_walls(points, global.distance_field(), there);
  evidence.nearby_nats = global.lead_of_nearby(points, there);
  evidence.correction_m = distance_m(there.translation(), predicted.translation());
  evidence.correction_rad = std::abs(wrap_angle(there.yaw_rad() - predicted.yaw_rad()));
  return evidence;
}

}  // namespace madori::localization
