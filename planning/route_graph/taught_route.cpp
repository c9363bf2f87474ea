#include "planning/route_graph/taught_route.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/angle.hpp"
#include "core/segment_distance.hpp"

namespace madori::planning {
namespace {

using Place = Point2<Map>;

constexpr double kStepM = 0.05;
constexpr double kStepRad = 0.05;
constexpr double kJumpM = 0.5;
constexpr double kOffWayM = 0.15;   ///< a leg may leave the way driven by so much
constexpr double kSameNodeM = 0.4;  ///< a place this near to a node is that node
constexpr double kOnLegM = 0.3;   ///< ... to a leg: it gets a node there; new legs go through nodes this near
constexpr double kStopS = 2.0;    ///< who stands for so long means the place
constexpr double kSpotRad = 0.6;  ///< turned by so much on one spot likewise

/// Which moments of a way surely get a node: its ends, stops, turns on the spot.
std::vector<std::size_t> marked(const std::vector<DrivenPose>& way) {
  std::vector<std::size_t> marks{0};
  for (std::size_t i = 0, j = 0; i + 1 < way.size(); i = std::max(i + 1, j)) {
    double turned_rad = 0.0;  // what follows at the same place
    const Place here = way[i].map_from_base.translation();
    for (j = i; j + 1 < way.size() && distance_m(here, way[j + 1].map_from_base.translation()) < kStepM; ++j)
      turned_rad += std::abs(wrap_angle(way[j + 1].map_from_base.yaw_rad() - way[j].map_from_base.yaw_rad()));
    // the time until the vehicle had left belongs to the stop
    const double stood_s = to_seconds(way[std::min(j + 1, way.size() - 1)].stamp - way[i].stamp);
    if (i > 0 && (stood_s >= kStopS || turned_rad >= kSpotRad)) marks.push_back(i);
  }
  marks.push_back(way.size() - 1);
  return marks;
}

/// Douglas and Peucker between two moments, which are kept; adds what lies between.
void simplify(const std::vector<DrivenPose>& way, std::size_t first, std::size_t last, double off_m,
              std::vector<std::size_t>& kept) {
  const Segment2<Map> leg{way[first].map_from_base.translation(), way[last].map_from_base.translation()};
  std::size_t farthest = first;
  double most_m = off_m;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double off = distance_m(leg, way[i].map_from_base.translation());
    if (off > most_m) {
      most_m = off;
      farthest = i;
    }
  }
  if (farthest == first) return;
  simplify(way, first, farthest, off_m, kept);
  kept.push_back(farthest);
  simplify(way, farthest, last, off_m, kept);
}

std::vector<Place> corners(const std::vector<DrivenPose>& way) {
  std::vector<Place> places;
  const auto marks = marked(way);
  for (std::size_t m = 0; m < marks.size(); ++m) {
    places.push_back(way[marks[m]].map_from_base.translation());
    std::vector<std::size_t> between;
    if (m + 1 < marks.size()) simplify(way, marks[m], marks[m + 1], kOffWayM, between);
    for (const std::size_t i : between) places.push_back(way[i].map_from_base.translation());
  }
  return places;
}

/// Routes that grow.
class Draft {
  using Leg = std::pair<std::size_t, std::size_t>;

 public:
  explicit Draft(const RouteGraph& routes) : nodes_(routes.nodes()) {
    for (const RouteLeg& leg : routes.legs()) legs_.emplace_back(leg.from, leg.to);
    for (const RouteNode& node : nodes_) next_id_ = std::max(next_id_, node.id + 1);
  }

  /// The node at a place: one that there is, one on a leg, else a new one.
  std::size_t node_at(const Place& at) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (distance_m(nodes_[i].position, at) < kSameNodeM &&
          (!best || distance_m(nodes_[i].position, at) < distance_m(nodes_[*best].position, at)))
        best = i;
    if (best) return *best;
    const auto off_m = [&](const Leg& leg) { return distance_m(line(leg), at); };
    const auto nearest = std::ranges::min_element(legs_, {}, off_m);
    if (nearest == legs_.end() || off_m(*nearest) >= kOnLegM) return add(at);
    return split(nearest->first, nearest->second, nearest_point(line(*nearest), at));
  }
  /// Through the nodes that lie on it.
  void join(std::size_t from, std::size_t to) {
    if (from == to) return;
    const Segment2<Map> leg{nodes_[from].position, nodes_[to].position};
    std::vector<std::pair<double, std::size_t>> through{{0.0, from}, {leg.length_m(), to}};
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (i != from && i != to && distance_m(leg, nodes_[i].position) < kOnLegM) {
        const double along = distance_m(leg.a, nearest_point(leg, nodes_[i].position));
        if (along > 0.0 && along < leg.length_m()) through.emplace_back(along, i);
      }
    std::ranges::sort(through);
    for (std::size_t k = 0; k + 1 < through.size(); ++k) {
      add_leg(through[k].second, through[k + 1].second);
      add_leg(through[k + 1].second, through[k].second);
    }
  }
  [[nodiscard]] RouteGraph take() {
    std::vector<RouteLeg> legs;
    for (const auto& [from, to] : legs_) legs.push_back({from, to, 0.0, 0});
    return {std::move(nodes_), std::move(legs)};
  }

 private:
  [[nodiscard]] Segment2<Map> line(const Leg& leg) const {
    return {nodes_[leg.first].position, nodes_[leg.second].position};
  }
  std::size_t add(const Place& at) {
    RouteNode node;
    node.id = next_id_++;
    node.position = at;
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }
  void add_leg(std::size_t from, std::size_t to) {
    if (std::ranges::find(legs_, std::pair(from, to)) == legs_.end()) legs_.emplace_back(from, to);
  }
  /// The leg's directions stay.
  std::size_t split(std::size_t from, std::size_t to, const Place& at) {
    const std::size_t node = add(at);
    for (const auto& [a, b] : {std::pair(from, to), std::pair(to, from)}) {
      const auto found = std::ranges::find(legs_, std::pair(a, b));
      if (found == legs_.end()) continue;
      *found = {a, node};
      add_leg(node, b);
    }
    return node;
  }

  std::vector<RouteNode> nodes_;
  std::vector<Leg> legs_;
  int next_id_ = 0;
};

}  // namespace

void note_way(std::vector<DrivenPose>& way, Stamp stamp, const Transform2<Map, Base>& map_from_base) {
  if (!way.empty()) {
    const auto step = way.back().map_from_base.inverse() * map_from_base;
    const double moved_m = std::hypot(step.x_m(), step.y_m());
    if (moved_m > kJumpM)
      way.clear();
    else if (moved_m < kStepM && std::abs(step.yaw_rad()) < kStepRad)
      return;
  }
  way.push_back({stamp, map_from_base});
}

double length_m(const std::vector<DrivenPose>& way) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    sum_m += distance_m(way[i - 1].map_from_base.translation(), way[i].map_from_base.translation());
  return sum_m;
}

RouteGraph taught(const RouteGraph& routes, const std::vector<DrivenPose>& way) {
  if (length_m(way) < kSameNodeM) return routes;
  Draft draft(routes);
  std::optional<std::size_t> last;
  for (const Place& place : corners(way)) {
    const std::size_t node = draft.node_at(place);
    if (last) draft.join(*last, node);
    last = node;
  }
  return draft.take();
}

}  // namespace madori::planning
