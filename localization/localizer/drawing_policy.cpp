// The localizer's dealings with the drawing: laying the memory on it, looking for other places.
#include <algorithm>

#include "localization/localizer/localizer.hpp"

namespace madori::localization {

/// How far off the believed start the first keyframe lies, nats.
double Localizer::surprise(const Transform2<Map, Base>& first) const {
  const double d = distance_m(first.translation(), initial_.map_from_base.translation()) / initial_.sigma_m;
  const double a = wrap_angle(first.yaw_rad() - initial_.map_from_base.yaw_rad()) / initial_.sigma_rad;
  return 0.5 * (d * d + a * a);
}

void Localizer::consult_drawing() {
  MemoryCloud cloud = memory_cloud(memory_);
  const Alignment found = drawing_->align(cloud, {});
  const Transform2<Map, Base>& first = memory_.poses().front();
  const double gain = found.gain - surprise(found.correction * first) + surprise(first);
  if (gain > options_.move_gain) {
    memory_.move(found.correction);
    cloud = memory_cloud(memory_);
  }
  drawing_->learn(cloud);
  evidence_.walls_seen = DrawingFit::walls_seen(cloud);
  if (evidence_.walls_seen > next_survey_walls_) {
    survey_drawing(cloud);
    cloud = memory_cloud(memory_);
  }
  evidence_.fit_nats = drawing_->likelihood(cloud, {}, std::max(0.1, drawing_->model().sigma_m));
  evidence_.inliers = drawing_->model().inliers;
  evidence_.sigma_m = drawing_->model().sigma_m;
  if (correct_recent_drift()) {
    cloud = memory_cloud(memory_);
  }
  std::vector<UnaryFactor> unary = drawing_->pulls(cloud, memory_.poses());
  UnaryFactor start;
  start.at = initial_.map_from_base;
  start.hessian = Eigen::Vector3d(1.0 / (initial_.sigma_m * initial_.sigma_m),
                                  1.0 / (initial_.sigma_m * initial_.sigma_m),
                                  1.0 / (initial_.sigma_rad * initial_.sigma_rad))
                      .asDiagonal();
  unary.push_back(start);
  memory_.optimise(unary);
}

/// Seldom: is there a better place, or does the mirror image fit better? A start pose that an operator gave
/// is never thrown away silently: the contradiction is reported.
void Localizer::survey_drawing(const MemoryCloud& cloud) {
  const Survey found = survey(*drawing_, cloud);
  evidence_.mirrored_nats = found.mirrored_nats - found.here_nats;
  evidence_.elsewhere_nats = found.elsewhere_nats - found.here_nats;
  const bool in_doubt = evidence_.elsewhere_nats > options_.health.rival_nats;
  next_survey_walls_ = evidence_.walls_seen * (in_doubt ? 1.3 : 2.0);
}

/// Global localization: the memory built so far is laid on all places of the drawing. Taken is a place that
/// explains it well and leads all others.
void Localizer::look_everywhere() {
  MemoryCloud cloud = memory_cloud(memory_);
  evidence_.walls_seen = DrawingFit::walls_seen(cloud);
  if (evidence_.walls_seen < std::max(options_.search_walls, next_survey_walls_)) {
    return;
  }
  next_survey_walls_ = 1.3 * evidence_.walls_seen;
  const Transform2<Map, Map> place = best_place_of_all(*drawing_, cloud);
  const Survey found = survey(*drawing_, moved(cloud, place));
  if (found.elsewhere_nats - found.here_nats > -options_.found_nats ||
      found.here_nats < options_.health.good_nats_a_wall * evidence_.walls_seen) {
    return;
  }
  memory_.move(place);
  initial_ = {memory_.poses().front(), 0.3, 0.1};
  evidence_.searching = false;
  next_survey_walls_ = std::max(30.0, 1.3 * evidence_.walls_seen);
  consult_drawing();
}

/// After being moved by hand: what was remembered lies elsewhere; the place is sought with a fresh memory.
void Localizer::start_search() {
  memory_ = Memory(options_.memory);
  evidence_ = {};
  evidence_.searching = true;
  next_survey_walls_ = 0.0;
  keyframes_since_solve_ = 0;
}

/// On an exact drawing, a stretch that lies beside it by many times the drawing's own error has drifted:
/// the walls it belongs to are sought anew. On a rough drawing the building's own shape is the better guide.
bool Localizer::correct_recent_drift() {
  const std::size_t first = memory_.window_begin();
  if (drawing_->model().sigma_m > options_.exact_drawing_m || first == 0) {
    return false;
  }
  const Alignment found = drawing_->align(memory_cloud(memory_, first), {0.8, 0.09});
  const Point2<Map> here = memory_.poses().back().translation();
  if (found.gain < 2.0 * options_.move_gain ||
      distance_m(found.correction * here, here) < 3.0 * drawing_->model().sigma_m) {
    return false;
  }
  memory_.move(found.correction, first);
  return true;
}

}  // namespace madori::localization
