#include "localization/localizer/map_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/drawing_fit/survey.hpp"

namespace madori::localization {

void MapState::think(const LocalizerOptions& options) {
  if (memory.empty()) return;
  memory.close_loops();
  memory.fuse();
  if (drawing && evidence.searching) {
    look_everywhere(options);
  } else if (drawing) {
    consult_drawing(options);
  } else if (memory.loops() > 0) {
    memory.optimise({});
  }
}

Transform2<Map, Map> MapState::take_in(MapState thought, std::size_t known) {
  const Transform2<Map, Map> by = memory.take_in(std::move(thought.memory), known);
  thought.memory = std::move(memory);
  thought.evidence.blind_scans = evidence.blind_scans;
  thought.evidence.blind_m = evidence.blind_m;
  thought.evidence.on_walls = evidence.on_walls;
  thought.evidence.on_memory = evidence.on_memory;
  *this = std::move(thought);
  return by;
}

bool MapState::drawing_fits(const HealthLimits& limits) const {
  return evidence.fit_nats > (evidence.verified ? limits.doubted_nats : limits.verified_nats) &&
         evidence.fit_nats > limits.good_nats_a_wall * evidence.walls_seen;
}

bool MapState::drawing_is_exact(const LocalizerOptions& options) const {
  return drawing && drawing->model().sigma_m < options.exact_drawing_m;
}

/// How far off the believed start the first keyframe lies, nats.
double MapState::surprise(const Transform2<Map, Base>& first) const {
  const double d = distance_m(first.translation(), start.map_from_base.translation()) / start.sigma_m;
  const double a = wrap_angle(first.yaw_rad() - start.map_from_base.yaw_rad()) / start.sigma_rad;
  return 0.5 * (d * d + a * a);
}

void MapState::consult_drawing(const LocalizerOptions& options) {
  MemoryCloud cloud = memory_cloud(memory);
  const Alignment found = drawing->align(cloud, {});
  const Transform2<Map, Base>& first = memory.poses().front();
  const double gain = found.gain - surprise(found.correction * first) + surprise(first);
  if (gain > options.move_gain) {
    memory.move(found.correction);
    cloud = memory_cloud(memory);
  }
  drawing->learn(cloud);
  evidence.walls_seen = DrawingFit::walls_seen(cloud);
  if (evidence.walls_seen > next_survey_walls) {
    survey_drawing(cloud, options);
    cloud = memory_cloud(memory);
  }
  evidence.fit_nats = drawing->likelihood(cloud, {}, std::max(0.1, drawing->model().sigma_m));
  evidence.verified = evidence.verified || evidence.fit_nats > options.health.verified_nats;
  evidence.inliers = drawing->model().inliers;
  evidence.sigma_m = drawing->model().sigma_m;
  if (correct_recent_drift(options)) {
    cloud = memory_cloud(memory);
  }
  std::vector<UnaryFactor> unary = drawing->pulls(cloud, memory.poses());
  UnaryFactor tie;
  tie.at = start.map_from_base;
  tie.hessian = Eigen::Vector3d(1.0 / (start.sigma_m * start.sigma_m), 1.0 / (start.sigma_m * start.sigma_m),
                                1.0 / (start.sigma_rad * start.sigma_rad))
                    .asDiagonal();
  unary.push_back(tie);
  memory.optimise(unary);
}

/// Seldom: is there a better place, or does the mirror image fit better? A start pose that an operator gave
/// is never thrown away silently: the contradiction is reported.
void MapState::survey_drawing(const MemoryCloud& cloud, const LocalizerOptions& options) {
  const Survey found = survey(*drawing, cloud);
  evidence.mirrored_nats = found.mirrored_nats - found.here_nats;
  evidence.elsewhere_nats = found.elsewhere_nats - found.here_nats;
  const bool in_doubt = evidence.elsewhere_nats > options.health.rival_nats || !drawing_fits(options.health);
  next_survey_walls = evidence.walls_seen * (in_doubt ? 1.3 : 2.0);
}

/// Global localization: the memory built so far is laid on all places of the drawing. Taken is a place that
/// explains it well and leads all others.
void MapState::look_everywhere(const LocalizerOptions& options) {
  MemoryCloud cloud = memory_cloud(memory);
  evidence.walls_seen = DrawingFit::walls_seen(cloud);
  if (evidence.walls_seen < std::max(options.search_walls, next_survey_walls)) {
    return;
  }
  next_survey_walls = 1.3 * evidence.walls_seen;
  const Transform2<Map, Map> place = best_place_of_all(*drawing, cloud);
  const Survey found = survey(*drawing, moved(cloud, place));
  if (found.elsewhere_nats - found.here_nats > -options.found_nats ||
      found.here_nats < options.health.good_nats_a_wall * evidence.walls_seen) {
    return;
  }
  memory.move(place);
  start = {memory.poses().front(), 0.3, 0.1};
  evidence.searching = false;
  next_survey_walls = std::max(30.0, 1.3 * evidence.walls_seen);
  consult_drawing(options);
}

/// How far beside its place the newest stretch is sought. What fits the drawing poorly though every scan
/// fitted the one before stands in a place that is drawn poorly. Where it fits the drawing as the rest does,
/// only an exact drawing knows better by centimetres: on a rough one the building's own shape is the better
/// guide.
AlignmentWindow MapState::drift_window(const MemoryCloud& recent, std::size_t first,
                                       const LocalizerOptions& options) const {
  const double walls = DrawingFit::walls_seen(recent);
  const double nats = drawing->likelihood(recent, {}, std::max(0.1, drawing->model().sigma_m));
  const double usual = evidence.fit_nats / std::max(1.0, evidence.walls_seen);
  if (walls > options.drift_walls && nats < options.drift_share * usual * walls &&
      memory.weakest_agreement(first) < options.drift_agreement) {
    return {options.drift_half_m, options.drift_half_rad, 250};
  }
  return drawing->model().sigma_m > options.exact_drawing_m ? AlignmentWindow{0.0, 0.0}
                                                            : AlignmentWindow{0.8, 0.09};
}

/// A stretch that lies beside the drawing, where it fits much better another way, has drifted: it is laid on
/// the walls that it belongs to. The farther off, and the more loops tie it to older keyframes where it is,
/// the more they have to say.
bool MapState::correct_recent_drift(const LocalizerOptions& options) {
  const std::size_t first = memory.window_begin();
  if (first == 0) {
    return false;
  }
  const MemoryCloud recent = memory_cloud(memory, first);
  const AlignmentWindow window = drift_window(recent, first, options);
  if (window.half_m <= 0.0) {
    return false;
  }
  const Alignment found = drawing->align(recent, window);
  const Point2<Map> here = memory.poses().back().translation();
  const double metres = distance_m(found.correction * here, here);
  const double turns = std::abs(found.correction.yaw_rad());
  const double far = 0.75 * std::log1p(16.0 * metres * metres + 400.0 * turns * turns);
  const bool exact =
      drawing->model().sigma_m < options.exact_drawing_m && window.half_m < options.drift_half_m;
  const bool clear = exact ? metres > 3.0 * drawing->model().sigma_m
                           : metres > options.drift_least_m || turns > options.drift_least_rad;
  const double against = std::max(0.0, memory.loops_against(found.correction, first));
  if (!clear || found.gain < 2.0 * options.move_gain + far + against) {
    return false;
  }
  memory.move(found.correction, first);
  return true;
}

}  // namespace madori::localization
