#include "planning/obstacle_check/obstacle_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::planning {
namespace {

constexpr float kGlimpseAboveM = 0.3F;  ///< nothing lower stands there as far as was seen
constexpr double kLevelSlackM = 0.1;    ///< below the lidar's height

/// Whether a layer holds such a column there or within so many cells beside it; two are a step.
template <class Is>
bool holds_beside(const ColumnLayer& layer, const Column& column, const Is& is, std::int32_t cells = 2) {
  for (std::int32_t dy = -cells; dy <= cells; ++dy)
    for (std::int32_t dx = -cells; dx <= cells; ++dx)
      if (const Column* there = layer.find(column.cell_x + dx, column.cell_y + dy))
        if (is(*there)) return true;
  return false;
}

bool is_any(const Column& /*column*/) {
  return true;
}

}  // namespace

/// One pass over the points: columns up to the vehicle's height and above it, and how far was seen.
void ObstacleField::take_scan(const PointCloud<Base>& scan, const SensorView& view,
                              const Transform2<Odom, Base>& odom_from_base) {
  const FieldOptions& o = options_;
  low_.begin(odom_from_base.translation(), o.reach_m, o.cell_m, scan.stamp);
  const Point2<Odom> lidar = odom_from_base * Point2<Base>{view.x_m, view.y_m};
  high_.begin(lidar, o.body_reach_m, o.cell_m, scan.stamp);
  level_.begin(lidar, o.body_reach_m, o.cell_m, scan.stamp);
  const bool is_kept = sights_.begin(view, odom_from_base, scan.stamp);
  const double reach_square = o.reach_m * o.reach_m;
  constexpr double kFurthestM2 = 1e6;
  for (const CloudPoint& p : scan.points) {
    const auto x = static_cast<double>(p.x_m);
    const auto y = static_cast<double>(p.y_m);
    const double dx = x - view.x_m;
    const double dy = y - view.y_m;
    const double away = dx * dx + dy * dy;
    const double height = ground_.height_of(p);
    if (!(away < kFurthestM2) || !std::isfinite(height)) continue;
    const bool above_floor = height > o.ground_clearance_m;
    if (height > view.z_m - kLevelSlackM && away < o.body_reach_m * o.body_reach_m)
      level_.add(odom_from_base * Point2<Base>{x, y}, height);
    if (is_kept) sights_.add(dx, dy, above_floor && height < o.body_top_m);
    if (!above_floor || !(height < o.body_top_m) || !(x * x + y * y < reach_square)) continue;
    if (height < o.top_m)
      low_.add(odom_from_base * Point2<Base>{x, y}, height);
    else if (away < o.body_reach_m * o.body_reach_m)
      high_.add(odom_from_base * Point2<Base>{x, y}, height);
  }
  note_what_stood(lidar, scan.stamp);
  low_.confirm(o.fewest_points, o.tall_m, stood_);
  high_.confirm(o.fewest_points, o.tall_m, stood_);
  note_what_came_over(lidar, view.z_m, scan.stamp);
}

/// Walls, racks, parked things: what was seen more than once, and never to come.
void ObstacleField::note_what_stood(const Point2<Odom>& lidar, Stamp now) {
  stood_.begin(lidar, options_.reach_m, options_.cell_m, now);
  for (const Column& old : columns_)
    if (old.confirmed && !old.came && old.since != old.seen)
      for (const float height_m : {old.low_m, old.high_m})
        stood_.add(old.centre(), static_cast<double>(height_m));
}

/// What is seen as high as the lidar where nothing stood.
void ObstacleField::note_what_came_over(const Point2<Odom>& lidar, double lidar_z_m, Stamp now) {
  over_.begin(lidar, options_.body_reach_m, options_.cell_m, now);
  for (const Column& above : high_.columns())
    if (above.confirmed && static_cast<double>(above.high_m) > lidar_z_m - kLevelSlackM &&
        !holds_beside(stood_, above, is_any, 1))
      over_.add(above.centre(), static_cast<double>(above.high_m));
}

void ObstacleField::take_within(const std::vector<Point2<Base>>& within,
                                const Transform2<Odom, Base>& odom_from_base, Stamp now) {
  double reach_m = 0.0;
  for (const auto& p : within) reach_m = std::max(reach_m, std::hypot(p.x_m, p.y_m));
  within_.begin(odom_from_base.translation(), std::min(reach_m, options_.reach_m), options_.cell_m, now);
  for (const auto& p : within) within_.add(odom_from_base * p, 0.0);
}

/// Whether something that is seen up to the vehicle's height may go on above it: it does, or that is not in
/// view. A load that ends below is seen to end. A vehicle higher than a person cuts nobody, and a head near
/// the rim of what its mast sees is hit by few lasers: there all count as persons.
bool ObstacleField::may_reach_up(const Column& column, const SensorView& view,
                                 const Transform2<Base, Odom>& base_from_odom) const {
  if (options_.top_m >= options_.body_top_m) return true;
  const Point2<Base> place = base_from_odom * column.centre();
  if (std::hypot(place.x_m - view.x_m, place.y_m - view.y_m) >= options_.body_reach_m) return true;
  if (!view.sees(place, options_.top_m, options_.body_top_m)) return true;
  return holds_beside(high_, column, is_any);
}

/// Columns are cut at the vehicle's height: what is part of something that goes on above it would have shown
/// there, too. What ends below it may just have come above the lowest beam.
bool ObstacleField::has_entered(const Column& column, const SensorView& view,
                                const Transform2<Base, Odom>& base_from_odom, Stamp now) const {
  if (to_seconds(now - column.since) > options_.sight.memory_s) return false;
  const bool is_cut = column.part_of_tall && may_reach_up(column, view, base_from_odom);
  const double top_m = is_cut ? options_.body_top_m : static_cast<double>(column.high_m);
  return sights_.was_empty(column.centre(), options_.cell_m, static_cast<double>(column.low_m), top_m, now);
}

/// A person beside the lidar: only what is higher than the vehicle is in view. What hung there all the time
/// is no person.
void ObstacleField::assume_feet(const SensorView& view, const Transform2<Odom, Base>& odom_from_base,
                                Stamp now) {
  const auto base_from_odom = odom_from_base.inverse();
  for (Column column : high_.columns()) {
    if (!column.confirmed || low_.find(column.cell_x, column.cell_y) != nullptr) continue;
    if (view.sees(base_from_odom * column.centre(), options_.ground_clearance_m, options_.top_m)) continue;
    if (!has_entered(column, view, base_from_odom, now)) continue;
    column.low_m = static_cast<float>(options_.ground_clearance_m);
    column.high_m = column.top_m = static_cast<float>(options_.top_m);
    column.part_of_tall = true;
    seen_.push_back(column);
  }
}

/// Whether something as high as the lidar, which it sees at any distance, is seen above a column or within
/// a step beside it. A wall that stood there before has no feet.
bool ObstacleField::is_under_something(const Column& column) const {
  return holds_beside(over_, column, is_any);
}

bool ObstacleField::keep(Column& old, const SensorView& view, const Transform2<Base, Odom>& base_from_odom,
                         Stamp now) const {
  const Point2<Base> place = base_from_odom * old.centre();
  if (std::hypot(place.x_m, place.y_m) > options_.reach_m) return false;
  old.entered = false;
  if (old.confirmed && holds_returns_within(old)) return true;
  if (view.sees(place, static_cast<double>(old.low_m), static_cast<double>(old.high_m))) {
    ++old.misses;
    return old.confirmed && old.misses < options_.misses_to_forget;
  }
  if (!old.confirmed) return false;
  if (is_under_something(old)) old.under = now;
  // One glimpse of something tall is the edge of what went by: what stands there is seen again and again.
  const bool glimpsed = old.part_of_tall && old.since == old.seen && old.low_m > kGlimpseAboveM;
  // A pallet that has come too near to be seen is still there; of a person the head would be seen. What came
  // as part of something tall, or below it, goes with it; what never was seen to come stood there before.
  const bool may_have_left = glimpsed || (old.came && (old.part_of_tall || old.under != Stamp{}));
  return !may_have_left || to_seconds(now - std::max(old.seen, old.under)) <= options_.foot_memory_s;
}

/// What this scan could not show of something is where it was: the near side of what the lowest beam begins
/// to pass over, what lies beside the field of view or falls within the outline.
void ObstacleField::keep_unseen_part(Column& fresh, const Column& old, const SensorView& view,
                                     const Transform2<Base, Odom>& base_from_odom) const {
  const bool all = holds_returns_within(old);
  for (const float x : {old.min_x_m, old.max_x_m})
    for (const float y : {old.min_y_m, old.max_y_m}) {
      const Point2<Odom> corner{static_cast<double>(x), static_cast<double>(y)};
      if (all || !view.sees(base_from_odom * corner, static_cast<double>(fresh.low_m),
                            static_cast<double>(fresh.top_m)))
        fresh.widen(corner);
    }
}

std::int32_t ObstacleField::cell_of(double at_m) const {
  return static_cast<std::int32_t>(std::floor(at_m / options_.cell_m));
}

bool ObstacleField::is_known(const Point2<Odom>& place) const {
  Column there;
  there.cell_x = cell_of(place.x_m);
  there.cell_y = cell_of(place.y_m);
  return std::binary_search(merged_.begin(), merged_.end(), there, by_cell);
}

/// Who comes into sight so near that the lowest beam passes over his near side shows the rim of his far side
/// only: no more of it than the beam falls across him, or a near side as high would have been seen first.
/// What reaches up to the lidar shows its near side, and so does what was seen further down: also where noise
/// puts its edge into another cell.
void ObstacleField::note_hidden_parts(const SensorView& view, const Transform2<Odom, Base>& odom_from_base,
                                      Stamp now) {
  const double beside_m = 1.5 * options_.cell_m;
  const double fall_m = -options_.hidden_m * std::tan(view.min_elevation_rad);
  const Point2<Odom> lidar = odom_from_base * Point2<Base>{view.x_m, view.y_m};
  const auto base_from_odom = odom_from_base.inverse();
  for (Column& c : merged_) {
    if (c.seen == now) {
      const double away_m = distance_m(c.centre(), lidar);
      const bool is_rim = static_cast<double>(c.high_m - c.low_m) <= fall_m;
      const bool above = c.low_m > kGlimpseAboveM && is_rim && away_m > options_.hidden_m;
      const double share = above ? options_.hidden_m / away_m : 0.0;
      c.hidden_x_m = static_cast<float>(share * (lidar.x_m - c.centre().x_m));
      c.hidden_y_m = static_cast<float>(share * (lidar.y_m - c.centre().y_m));
    }
    if (!c.has_hidden_part()) continue;
    const Point2<Odom> beside = c.hidden_at(beside_m);
    const bool seen =
        view.sees(base_from_odom * beside, static_cast<double>(c.low_m), static_cast<double>(c.high_m));
    const auto is_low = [](const Column& there) { return there.low_m <= kGlimpseAboveM; };
    if (seen || holds_beside(stood_, c, is_low, 1) || is_known(beside) ||
        is_known(c.hidden_at(2.0 * beside_m)) || holds_beside(level_, c, is_any))
      c.hidden_x_m = c.hidden_y_m = 0.0F;
  }
}

void ObstacleField::update(const PointCloud<Base>& scan, const SensorView& view,
                           const Transform2<Odom, Base>& odom_from_base,
                           const std::vector<Point2<Base>>& within) {
  const bool sees_floor = view.min_elevation_rad < 0.0;
  if (sees_floor) ground_ = fit_ground(scan.points);
  take_scan(scan, view, odom_from_base);
  take_within(within, odom_from_base, scan.stamp);
  seen_ = low_.columns();
  assume_feet(view, odom_from_base, scan.stamp);
  std::sort(seen_.begin(), seen_.end(), by_cell);
  const auto base_from_odom = odom_from_base.inverse();
  merged_.clear();
  merged_.reserve(seen_.size() + columns_.size());
  auto fresh = seen_.begin();
  for (Column& old : columns_) {
    while (fresh != seen_.end() && by_cell(*fresh, old)) merged_.push_back(*fresh++);
    if (fresh != seen_.end() && !by_cell(old, *fresh)) {
      Column both = *fresh++;
      both.confirmed = true;  // seen twice in one place
      both.since = old.since;
      both.under = old.under;
      both.came = old.came;
      both.high_m = std::max(both.high_m, old.high_m);
      both.low_m = std::min(both.low_m, old.low_m);
      both.top_m = std::max(both.top_m, old.top_m);
      if (old.confirmed) keep_unseen_part(both, old, view, base_from_odom);
      merged_.push_back(both);
    } else if (keep(old, view, base_from_odom, scan.stamp)) {
      merged_.push_back(old);
    }
  }
  merged_.insert(merged_.end(), fresh, seen_.end());
  for (Column& column : merged_) {
    if (column.seen != scan.stamp) continue;
    column.entered = has_entered(column, view, base_from_odom, scan.stamp);
    column.came = column.came || column.entered;
    if (is_under_something(column)) column.under = scan.stamp;
  }
  note_hidden_parts(view, odom_from_base, scan.stamp);
  std::swap(columns_, merged_);
}

void ObstacleField::forget_near(const Point2<Odom>& place, double radius_m) {
  std::erase_if(columns_, [&](const Column& c) { return distance_m(c.centre(), place) < radius_m; });
}

void ObstacleField::add_felt(const std::vector<Point2<Odom>>& places, Stamp now) {
  constexpr double kHighM = 0.3;
  for (const auto& place : places) {
    Column felt;
    felt.cell_x = cell_of(place.x_m);
    felt.cell_y = cell_of(place.y_m);
    felt.min_x_m = felt.max_x_m = static_cast<float>(place.x_m);
    felt.min_y_m = felt.max_y_m = static_cast<float>(place.y_m);
    felt.low_m = static_cast<float>(options_.ground_clearance_m);
    felt.high_m = felt.top_m = static_cast<float>(kHighM);
    felt.since = now;
    auto at = std::lower_bound(columns_.begin(), columns_.end(), felt, by_cell);
    if (at == columns_.end() || by_cell(felt, *at)) at = columns_.insert(at, felt);
    at->min_x_m = std::min(at->min_x_m, felt.min_x_m);
    at->max_x_m = std::max(at->max_x_m, felt.max_x_m);
    at->min_y_m = std::min(at->min_y_m, felt.min_y_m);
    at->max_y_m = std::max(at->max_y_m, felt.max_y_m);
    at->confirmed = true;
  }
}

}  // namespace madori::planning
