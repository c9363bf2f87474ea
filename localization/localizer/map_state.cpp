#include "localization/localizer/map_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::localization {

void OnDrawing::set_earlier(std::shared_ptr<const Memory> memory) {
  earlier = std::move(memory);
  known.reset();
}

void MapState::think(const LocalizerOptions& options) {
  if (memory.empty()) return;
  if (placed && drawing_is_exact(options) && evidence.here > options.health.localized)
    memory.skip_loops();  // an exact drawing ties every place already
  else
    memory.close_loops();
  memory.fuse();
  if (drawing)
    place(options);
  else if (memory.loops() > 0)
    memory.optimise({});
  memory.make_room();
}

Transform2<Map, Map> MapState::take_in(MapState& thought, std::size_t known) {
  const Transform2<Map, Map> by = memory.take_in(thought.memory, known);
  std::swap(thought.memory, memory);
  thought.evidence.blind_scans = evidence.blind_scans;
  thought.evidence.blind_m = evidence.blind_m;
  thought.evidence.on_walls = evidence.on_walls;
  thought.evidence.on_memory = evidence.on_memory;
  std::swap(*this, thought);
  return by;
}

bool MapState::drawing_fits(const LocalizerOptions& options) const {
  return drawing && placed && evidence.here > options.health.believed;
}

bool MapState::drawing_is_exact(const LocalizerOptions& options) const {
  return drawing && drawing->walls.drawn().model().sigma_m < options.exact_drawing_m;
}

void MapState::move(const Transform2<Map, Map>& by) {
  memory.move(by);
  drawing->belief.moved(by);
}

void MapState::place(const LocalizerOptions& options) {
  MemoryCloud cloud = memory_cloud(memory);
  evidence.walls_seen = DrawingFit::walls_seen(cloud);
  const bool several_ways = weigh_places(cloud, options);
  if (placed) {
    cloud = memory_cloud(memory);
    if (!several_ways) settle(cloud, options);
    lay_on_drawing(cloud, options);
  }
  const Transform2<Map, Base>& at = memory.poses().back();
  evidence.here = placed ? drawing->belief.probability_here(at) : 0.0;
  evidence.around = placed ? drawing->belief.probability_around(at, at) : 0.0;
  if (const auto bent = drawing->walls.bent(); placed && bent) {
    evidence.here *= bent->share_within(at, kNearM);
    evidence.around *= bent->share_within(at, kAroundM);
  }
  if (unconfirmed_size == memory.size())
    evidence.here = evidence.around = std::min(evidence.here, options.unconfirmed);
  evidence.rival = drawing->belief.probability_elsewhere(at);
  evidence.mirrored = drawing->belief.probability_mirrored();
}

/// All places are compared while it is not sure which one it is, and now and then afterwards. The memory goes
/// where most of the belief is, and to the middle of it where several ways to lie at one place are likely: a
/// wall that is drawn too thick draws the memory to either face.
bool MapState::weigh_places(const MemoryCloud& cloud, const LocalizerOptions& options) {
  const bool unsure = !placed || evidence.here < options.health.localized;
  const bool everywhere = !evidence.looked || evidence.walls_seen > next_survey_walls;
  if (drawing->earlier && !drawing->known)
    drawing->known = std::make_shared<const KnownBuilding>(drawing->walls.standing(), *drawing->earlier);
  std::vector<Transform2<Map, Base>> recognised;
  if (everywhere && drawing->known)
    recognised = drawing->known->crossings.where(*memory.keyframes().back().scan);
  drawing->belief.weigh(drawing->to_find_by(), memory, cloud, start, memory.poses().back(), everywhere,
                        recognised);
  if (everywhere) {
    evidence.looked = true;
    next_survey_walls = evidence.walls_seen * (unsure ? options.survey_growth_unsure : options.survey_growth);
  }
  const auto best = drawing->belief.best();
  if (!best) return false;
  const Transform2<Map, Base>& at = memory.poses().back();
  const double here = drawing->belief.probability_here(at);
  const bool clear = best->probability > options.health.believed;
  // Where neither its own place nor another is believed, it goes to the middle of all that is around it.
  const bool nowhere = !clear && here < options.health.believed;
  const auto middle = drawing->belief.middle_around(at, nowhere);
  if (placed && drawing->belief.probability_around(at, nowhere ? middle : at) >= options.health.localized) {
    const bool several_ways = best->probability < options.health.localized;
    if (several_ways || here < options.health.believed) move(middle * at.inverse());
    return several_ways;
  }
  const bool leaves = placed && clear && here < options.health.believed;
  if (leaves) {
    unconfirmed_size = memory.size();  // a place that was wrong once is believed when more agrees
    drawing->walls.straighten();
    drawing->set_earlier(nullptr);
  }
  if (!placed || leaves) move(best->correction);
  placed = placed || clear || start.has_value();
  return false;
}

/// The memory as a whole goes to where the drawing explains it best, but from no likely place to one that is
/// believed less: wall for wall the one may fit better, where the walls vote for the other.
void MapState::settle(MemoryCloud& cloud, const LocalizerOptions& options) {
  const Alignment found =
      drawing->walls.drawn().align(cloud, {options.settle_half_m, options.settle_half_rad});
  const Transform2<Map, Base>& first = memory.poses().front();
  const double area_m2 = drawing->belief.area_m2();
  const double told_so =
      start ? log_prior(*start, found.correction * first, area_m2) - log_prior(*start, first, area_m2) : 0.0;
  const Transform2<Map, Base>& at = memory.poses().back();
  const bool less_likely =
      drawing->belief.probability_near(at, found.correction * at) < drawing->belief.probability_here(at);
  if (found.gain + told_so <= options.move_gain || less_likely) return;
  move(found.correction);
  cloud = memory_cloud(memory);
}

/// The drawing is learned by what is seen, and pulls on the memory's keyframes.
void MapState::lay_on_drawing(MemoryCloud& cloud, const LocalizerOptions& options) {
  drawing->walls.learn(cloud);
  const DrawingFit& fit = drawing->walls.standing();
  evidence.inliers = fit.model().inliers;
  evidence.sigma_m = fit.model().sigma_m;
  evidence.nats_a_wall =
      fit.likelihood(cloud, {}, std::max(0.1, evidence.sigma_m)) / std::max(1.0, evidence.walls_seen);
  if (correct_recent_drift(options)) cloud = memory_cloud(memory);
  std::vector<UnaryFactor> unary =
      drawing->walls.drawn().pulls(cloud, memory.poses(), drawing->walls.shared_error());
  // What was told holds the memory by as much as it is believed where the memory lies.
  const Transform2<Map, Base>& first = memory.poses().front();
  const double as_told = start ? prior_holds(*start, first, drawing->belief.area_m2()) : 0.0;
  const StartPrior placed_here{first, options.tie_m, options.tie_rad};
  if (start) unary.push_back({0, start->map_from_base, as_told * start->information()});
  unary.push_back({0, first, (1.0 - as_told) * placed_here.information()});
  memory.optimise(unary);
  // Only now: what has drifted is pulled back by what was known, before the drawing is bent to it.
  if (drawing->belief.probability_here(memory.poses().back()) > options.health.localized)
    drawing->walls.bend(memory_cloud(memory), memory.poses().back().translation(), told_of_warp());
}

/// A pose that was given says where on the drawing the memory begins, and so how the drawing is bent there.
WarpPrior MapState::told_of_warp() const {
  if (!told) return {};
  const Transform2<Map, Base>& first = memory.poses().front();
  const Transform2<Building, Base> began(first.x_m(), first.y_m(), first.yaw_rad());
  return [prior = *told, began, area_m2 = drawing->belief.area_m2()](const DrawingWarp& warp) {
    return log_prior(prior, warp.map(began), area_m2);
  };
}

/// How far beside its place the newest stretch is sought. What fits the drawing poorly though every scan
/// fitted the one before stands in a place that is drawn poorly. Where it fits the drawing as the rest does,
/// only an exact drawing knows better by centimetres: on a rough one the building's own shape is the better
/// guide.
AlignmentWindow MapState::drift_window(const MemoryCloud& recent, std::size_t first,
                                       const LocalizerOptions& options) const {
  const double walls = DrawingFit::walls_seen(recent);
  const DrawingFit& fit = drawing->walls.drawn();
  const double nats = fit.likelihood(recent, {}, std::max(0.1, fit.model().sigma_m));
  const double usual = evidence.nats_a_wall;
  if (walls > options.drift_walls && nats < options.drift_share * usual * walls &&
      memory.weakest_agreement(first) < options.drift_agreement) {
    return {options.drift_half_m, options.drift_half_rad, 250};
  }
  return drawing_is_exact(options) ? AlignmentWindow{0.8, 0.09} : AlignmentWindow{0.0, 0.0};
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
  const Alignment found = drawing->walls.drawn().align(recent, window);
  const Point2<Map> here = memory.poses().back().translation();
  const double metres = distance_m(found.correction * here, here);
  const double turns = std::abs(found.correction.yaw_rad());
  const double far = 0.75 * std::log1p(16.0 * metres * metres + 400.0 * turns * turns);
  const bool exact = drawing_is_exact(options) && window.half_m < options.drift_half_m;
  const bool clear = exact ? metres > 3.0 * drawing->walls.drawn().model().sigma_m
                           : metres > options.drift_least_m || turns > options.drift_least_rad;
  const double against = std::max(0.0, memory.loops_against(found.correction, first));
  if (!clear || found.gain < 2.0 * options.move_gain + far + against) {
    return false;
  }
  memory.move(found.correction, first);
  return true;
}

}  // namespace madori::localization
