#include "tests/bench/movers/nearest_neighbour.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/segment_distance.hpp"

namespace madori::bench {
namespace {

std::int64_t number_of(std::int64_t x, std::int64_t y) {
  constexpr std::int64_t kRow = std::int64_t{1} << 32U;
  return y * kRow + x;
}

}  // namespace

void NearestNeighbour::Cluster::add(const Cluster& other) {
  low = {std::min(low.x_m, other.low.x_m), std::min(low.y_m, other.low.y_m)};
  high = {std::max(high.x_m, other.high.x_m), std::max(high.y_m, other.high.y_m)};
  points += other.points;
}

bool NearestNeighbour::is_on_wall(const Point2<Map>& at) const {
  return walls_->any_near(at, options_.off_walls_m, [&](const Segment2<Map>& wall) {
    return distance_m(wall, at) < options_.off_walls_m;
  });
}

void NearestNeighbour::lay_out(const PointCloud<Base>& scan,
                               const Transform2<Building, Base>& building_from_base) {
  cells_.clear();
  places_.clear();
  for (const CloudPoint& p : scan.points) {
    const auto z_m = static_cast<double>(p.z_m);
    const Point2<Base> seen{static_cast<double>(p.x_m), static_cast<double>(p.y_m)};
    if (z_m < options_.low_m || z_m > options_.high_m) continue;
    if (!(std::hypot(seen.x_m, seen.y_m) < options_.reach_m)) continue;
    const Point2<Building> at = building_from_base * seen;
    if (is_on_wall(frames_.map_from_plan * frames_.plan(at))) continue;
    const auto x = static_cast<std::int64_t>(std::floor(at.x_m / options_.cell_m));
    const auto y = static_cast<std::int64_t>(std::floor(at.y_m / options_.cell_m));
    const auto [place, is_new] = places_.try_emplace(number_of(x, y), cells_.size());
    if (is_new)
      cells_.push_back({x, y, {at, at, 1}});
    else
      cells_[place->second].content.add({at, at, 1});
  }
}

NearestNeighbour::Cluster NearestNeighbour::flood(std::size_t first) {
  Cluster cluster = cells_[first].content;
  cluster.points = 0;
  std::vector<std::size_t> members{first};
  cells_[first].taken = true;
  for (std::size_t next = 0; next < members.size(); ++next) {
    const Cell cell = cells_[members[next]];
    cluster.add(cell.content);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto there = places_.find(number_of(cell.x + dx, cell.y + dy));
        if (there == places_.end() || cells_[there->second].taken) continue;
        cells_[there->second].taken = true;
        members.push_back(there->second);
      }
  }
  return cluster;
}

std::vector<NearestNeighbour::Cluster> NearestNeighbour::clusters() {
  std::vector<Cluster> found;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].taken) continue;
    const Cluster cluster = flood(i);
    if (cluster.points >= options_.fewest_points && cluster.width_m() <= options_.widest_m)
      found.push_back(cluster);
  }
  return found;
}

void NearestNeighbour::follow(const std::vector<Cluster>& found, Stamp stamp) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      const double away_m = distance_m(found[i].centre(), tracks_[k].places.back().second);
      if (away_m < options_.gate_m) pairs.emplace_back(away_m, i, k);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<Track> followed(found.size());
  std::vector<bool> given(tracks_.size(), false);
  for (const auto& [away_m, i, k] : pairs) {
    if (given[k] || !followed[i].places.empty()) continue;
    given[k] = true;
    followed[i] = std::move(tracks_[k]);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    auto& places = followed[i].places;
    places.emplace_back(stamp, found[i].centre());
    followed[i].radius_m = 0.5 * found[i].width_m();
    while (to_seconds(stamp - places.front().first) > options_.history_s) places.pop_front();
  }
  tracks_ = std::move(followed);
}

void NearestNeighbour::update(const PointCloud<Base>& scan,
                              const Transform2<Building, Base>& building_from_base) {
  lay_out(scan, building_from_base);
  follow(clusters(), scan.stamp);
}

std::vector<ToldMover> NearestNeighbour::faster_than(double speed_mps) const {
  std::vector<ToldMover> told;
  for (const Track& track : tracks_) {
    const auto& [begun, from] = track.places.front();
    const auto& [now, at] = track.places.back();
    const double time_s = to_seconds(now - begun);
    if (time_s < options_.shortest_s) continue;
    const ToldMover mover{at, (at.x_m - from.x_m) / time_s, (at.y_m - from.y_m) / time_s, track.radius_m};
    const double speed = std::hypot(mover.vx_mps, mover.vy_mps);
    if (speed > speed_mps && speed < options_.fastest_mps) told.push_back(mover);
  }
  return told;
}

}  // namespace madori::bench
