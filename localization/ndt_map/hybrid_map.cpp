#include "localization/ndt_map/hybrid_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "localization/ndt_map/beam_in_cell.hpp"
#include "mapping/wall_map/grid_frame.hpp"

namespace madori::localization {
namespace {

/// The part of its way on which a beam is between two heights.
struct Way {
  double from = 0.0;
  double to = 1.0;
};

Way between_heights(const MapBeam& beam, double low_m, double high_m) {
  Way way;
  if (beam.dz_m == 0.0) {
    if (beam.z_m < low_m || beam.z_m > high_m) way.to = -1.0;
    return way;
  }
  const double a = (low_m - beam.z_m) / beam.dz_m;
  const double b = (high_m - beam.z_m) / beam.dz_m;
  return {std::max(0.0, std::min(a, b)), std::min(1.0, std::max(a, b))};
}

/// Goes through the cells that a straight way crosses (Amanatides and Woo 1987), and tells the part of the
/// way in each.
template <class Visit>
void walk(const MapBeam& beam, const Way& way, double cell_m, Visit&& visit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double x = (beam.x_m + way.from * beam.dx_m) / cell_m;
  const double y = (beam.y_m + way.from * beam.dy_m) / cell_m;
  CellPlace at{static_cast<std::int32_t>(std::floor(x)), static_cast<std::int32_t>(std::floor(y))};
  const double dx = beam.dx_m / cell_m;
  const double dy = beam.dy_m / cell_m;
  const std::int32_t right = dx > 0.0 ? 1 : -1;
  const std::int32_t up = dy > 0.0 ? 1 : -1;
  const auto first = [&](double at_m, std::int32_t cell, double d) {
    if (d == 0.0) return kNever;
    return way.from + ((d > 0.0 ? cell + 1.0 : static_cast<double>(cell)) - at_m) / d;
  };
  double next_x = first(x, at.column, dx);
  double next_y = first(y, at.row, dy);
  const double step_x = dx == 0.0 ? kNever : std::abs(1.0 / dx);
  const double step_y = dy == 0.0 ? kNever : std::abs(1.0 / dy);
  for (double from = way.from; from < way.to;) {
    const double to = std::min({next_x, next_y, way.to});
    visit(at, from, to);
    from = to;
    if (next_x < next_y) {
      at.column += right;
      next_x += step_x;
    } else {
      at.row += up;
      next_y += step_y;
    }
  }
}

/// Whether a surface, where it is one, runs more across the line than along it.
bool runs_across(const GaussianAxes& axes, const Segment2<Map>& line) {
  if (!axes.is_surface()) return false;
  const double x = line.b.x_m - line.a.x_m, y = line.b.y_m - line.a.y_m;
  return std::abs(axes.normal_x * x + axes.normal_y * y) > std::abs(axes.normal_x * y - axes.normal_y * x);
}

}  // namespace

/// A beam with what of it counts.
struct HybridMap::Ray {
  MapBeam beam;
  Way way;         ///< within the heights and the range
  bool ends_here;  ///< its end is of something that stands there
  CellPlace end;
};

CellPlace HybridMap::place_of(const Point2<Map>& p) const {
  return {static_cast<std::int32_t>(std::floor(p.x_m / options_.cell_m)),
          static_cast<std::int32_t>(std::floor(p.y_m / options_.cell_m))};
}

Point2<Map> HybridMap::centre(const CellPlace& place) const {
  return {(place.column + 0.5) * options_.cell_m, (place.row + 0.5) * options_.cell_m};
}

CellState HybridMap::state_at(const Point2<Map>& p) const {
  const CellPlace place = place_of(p);
  const CellTree::Index cell = CellTree::holds(place) ? cells_.find(place) : CellTree::kNone;
  return cell == CellTree::kNone ? CellState::Unseen : state(cell);
}

HybridMap::Sighting& HybridMap::sighting(CellTree::Index cell) {
  if (cell >= sighting_of_.size()) sighting_of_.resize(cells_.size(), 0);
  if (sighting_of_[cell] == 0) {
    sightings_.emplace_back().cell = cell;
    sighting_of_[cell] = static_cast<std::uint32_t>(sightings_.size());
  }
  return sightings_[sighting_of_[cell] - 1];
}

void HybridMap::hit(const Ray& ray) {
  if (!ray.ends_here) return;
  const auto& b = ray.beam;
  Sighting& seen = sighting(cells_.at(ray.end));
  seen.ends.add(b.x_m + b.dx_m, b.y_m + b.dy_m, b.z_m + b.dz_m, options_.most_samples);
  seen.evidence += options_.hit;
}

void HybridMap::pass(const Ray& ray) {
  walk(ray.beam, ray.way, options_.cell_m, [&](const CellPlace& place, double from, double to) {
    if (ray.ends_here && place == ray.end) return;
    const auto cell = cells_.at(place);
    const double low_m = ray.beam.z_m + (ray.beam.dz_m < 0.0 ? to : from) * ray.beam.dz_m;
    cells_[cell].clear_above_m = std::min(cells_[cell].clear_above_m, static_cast<float>(low_m));
    const CellGaussian& gaussian = cells_[cell].gaussian;
    const double surely = gaussian.empty() ? 1.0 : refutes(ray.beam, from, to, gaussian, options_.surface_m);
    sighting(cell).evidence -= options_.pass * surely;
  });
}

void HybridMap::look(const Beams& beams, const Transform2<Map, Base>& map_from_base, Stamp stamp) {
  const Point2<Map> eye = map_from_base * beams.sensor;
  const double reach_m = (CellTree::kHalf - 2) * options_.cell_m - options_.range_max_m;
  if (!map_from_base.is_finite() || !(std::abs(eye.x_m) < reach_m && std::abs(eye.y_m) < reach_m)) return;
  std::vector<Ray> rays;
  rays.reserve(beams.ends.size());
  for (const Beams::End& end : beams.ends) {
    const Point2<Map> at = map_from_base * Point2<Base>{end.x_m, end.y_m};
    Ray ray{
        {eye.x_m, eye.y_m, beams.sensor_z_m, at.x_m - eye.x_m, at.y_m - eye.y_m, end.z_m - beams.sensor_z_m},
        {},
        false,
        {}};
    const double range_m = std::hypot(ray.beam.dx_m, ray.beam.dy_m);
    if (!(range_m > options_.range_min_m) || !std::isfinite(range_m + ray.beam.dz_m)) continue;
    ray.way = between_heights(ray.beam, options_.low_m, options_.high_m);
    ray.ends_here = range_m < options_.range_max_m && ray.way.to == 1.0;
    ray.way.to = std::min(ray.way.to, options_.range_max_m / range_m);
    if (ray.ends_here) ray.end = place_of(at);
    rays.push_back(ray);
  }
  for (const Ray& ray : rays) hit(ray);
  for (Sighting& seen : sightings_) take_shape(seen, stamp);
  for (const Ray& ray : rays) pass(ray);
  settle(stamp);
}

/// The shape is of what stands there now: another day may have put another thing into the cell. What lasts
/// keeps its own, and is known again by it.
void HybridMap::take_shape(Sighting& seen, Stamp stamp) {
  MapCell& cell = cells_[seen.cell];
  const CellGaussian& known = cell.lasting.empty() ? cell.gaussian : cell.lasting;
  if (!known.empty()) seen.same_thing = same_surface(seen.ends, known, options_.surface_m);
  const double since_s = cell.layers.was_seen() ? std::max(0.0, to_seconds(stamp - cell.layers.seen)) : 0.0;
  cell.gaussian.samples *= static_cast<float>(std::exp(-since_s / options_.layers.permanent_tau_s));
  cell.gaussian.merge(seen.ends, options_.most_samples);
}

/// The look's evidence goes into the layers. Where nothing is left of what stood there, its shape goes, too.
void HybridMap::settle(Stamp stamp) {
  newest_ = std::max(newest_, stamp);
  for (const Sighting& seen : sightings_) {
    MapCell& cell = cells_[seen.cell];
    const bool is_below = seen.ends.z_m + static_cast<float>(options_.surface_m) < cell.clear_above_m;
    if (!seen.ends.empty() && is_below) cell.layers.forget_free();
    cell.layers.take(seen.evidence, stamp, options_.layers, seen.same_thing);
    if (!cell.layers.lasts(options_.layers)) {
      cell.lasting = {};
    } else if (cell.lasting.empty()) {
      cell.lasting = cell.gaussian;
    }
    if (cell.layers.now <= -options_.layers.now_most && cell.layers.stands < 0.0F) cell.gaussian = {};
    sighting_of_[seen.cell] = 0;
  }
  sightings_.clear();
  if (cells_.size() > options_.most_cells) forget_oldest();
}

void HybridMap::forget_oldest() {
  std::vector<CellTree::Index> order(cells_.size());
  for (CellTree::Index i = 0; i < order.size(); ++i) order[i] = i;
  const auto older = [&](CellTree::Index a, CellTree::Index b) {
    return cells_[a].layers.seen != cells_[b].layers.seen ? cells_[a].layers.seen > cells_[b].layers.seen
                                                          : a < b;
  };
  std::sort(order.begin(), order.end(), older);
  order.resize(options_.most_cells - options_.most_cells / 8);
  CellTree kept;
  for (const auto i : order) kept[kept.at(cells_.place(i))] = cells_[i];
  cells_ = std::move(kept);
  sighting_of_.assign(cells_.size(), 0);
}

CellState HybridMap::state(CellTree::Index cell) const {
  const MapCell& c = cells_[cell];
  const bool is_what_lasts = c.gaussian.empty() || c.lasting.empty() ||
                             same_surface(c.gaussian, c.lasting, options_.surface_m) > 0.5;
  return c.layers.state(newest_, options_.layers, drawn_as(c), is_what_lasts);
}

/// A thing that stands before a wall, or on a line of the floor, has faces across it.
DrawnAs HybridMap::drawn_as(const MapCell& cell) const {
  if (cell.gaussian.empty()) return DrawnAs::Nothing;
  const Point2<Map> at{cell.gaussian.x_m, cell.gaussian.y_m};
  const double near_m = options_.drawn_m();
  DrawnAs found = DrawnAs::Nothing;
  for (const std::int32_t line : cell.drawn) {
    if (line < 0) continue;
    const auto i = static_cast<std::size_t>(line);
    if (mapping::squared_distance_m2(drawn_[i], at) < near_m * near_m &&
        !runs_across(cell.gaussian.axes(), drawn_[i]))
      found = std::max(found, i < drawn_walls_ ? DrawnAs::Wall : DrawnAs::Line);
  }
  return found;
}

/// Cells that hold something of the band around a line, where no two others are nearer to their middle, nor
/// walls, if it is none.
void HybridMap::mark_drawn(std::int32_t line_number) {
  const auto is_wall = [&](std::int32_t i) { return static_cast<std::size_t>(i) < drawn_walls_; };
  const Segment2<Map>& line = drawn_[static_cast<std::size_t>(line_number)];
  const double reach_m = options_.drawn_m() + 0.75 * options_.cell_m;  // to the middle of such a cell
  const auto low =
      place_of({std::min(line.a.x_m, line.b.x_m) - reach_m, std::min(line.a.y_m, line.b.y_m) - reach_m});
  const auto high =
      place_of({std::max(line.a.x_m, line.b.x_m) + reach_m, std::max(line.a.y_m, line.b.y_m) + reach_m});
  for (auto row = low.row; row <= high.row; ++row)
    for (auto column = low.column; column <= high.column; ++column) {
      const CellPlace place{column, row};
      const double away_m2 = mapping::squared_distance_m2(line, centre(place));
      if (!CellTree::holds(place) || away_m2 > reach_m * reach_m) continue;
      auto& [first, second] = cells_[cells_.at(place)].drawn;
      const auto nearer_than = [&](std::int32_t other) {
        if (other < 0 || is_wall(line_number) != is_wall(other)) return other < 0;
        return away_m2 < mapping::squared_distance_m2(drawn_[static_cast<std::size_t>(other)], centre(place));
      };
      if (nearer_than(first)) {
        second = std::exchange(first, line_number);
      } else if (nearer_than(second)) {
        second = line_number;
      }
    }
}

void HybridMap::draw(const mapping::Walls& walls, const mapping::Walls& other_lines) {
  for (CellTree::Index i = 0; i < cells_.size(); ++i) cells_[i].drawn = {-1, -1};
  drawn_.clear();
  for (const mapping::Wall& wall : walls) drawn_.push_back(wall.segment);
  drawn_walls_ = drawn_.size();
  for (const mapping::Wall& line : other_lines)
    if (line.segment.length_m() >= options_.shortest_m) drawn_.push_back(line.segment);
  for (std::size_t i = 0; i < drawn_.size(); ++i) mark_drawn(static_cast<std::int32_t>(i));
}

void HybridMap::restore(const CellPlace& place, const MapCell& cell) {
  if (!CellTree::holds(place)) return;
  cells_[cells_.at(place)] = cell;
  newest_ = std::max(newest_, cell.layers.seen);
}

}  // namespace madori::localization
