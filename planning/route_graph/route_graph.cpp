#include "planning/route_graph/route_graph.hpp"

#include <algorithm>
#include <utility>

namespace madori::planning {

RouteGraph::RouteGraph(std::vector<RouteNode> nodes, std::vector<RouteLeg> legs)
    : nodes_(std::move(nodes)), legs_(std::move(legs)), first_leg_(nodes_.size() + 1, 0) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) index_.emplace(nodes_[i].id, i);
  std::stable_sort(legs_.begin(), legs_.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  for (RouteLeg& leg : legs_) {
    leg.length_m = distance_m(nodes_[leg.from].position, nodes_[leg.to].position);
    ++first_leg_[leg.from + 1];
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) first_leg_[i + 1] += first_leg_[i];
}

std::span<const RouteLeg> RouteGraph::legs_from(std::size_t node) const {
  return std::span(legs_).subspan(first_leg_[node], first_leg_[node + 1] - first_leg_[node]);
}

bool RouteGraph::has_leg(std::size_t from, std::size_t to) const {
  const auto legs = legs_from(from);
  return std::any_of(legs.begin(), legs.end(), [to](const RouteLeg& leg) { return leg.to == to; });
}

std::optional<std::size_t> RouteGraph::index_of(int id) const {
  const auto found = index_.find(id);
  if (found == index_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::size_t> RouteGraph::find(const std::string& id_or_name) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (std::to_string(nodes_[i].id) == id_or_name) return i;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (!nodes_[i].name.empty() && nodes_[i].name == id_or_name) return i;
  return std::nullopt;
}

std::vector<std::size_t> RouteGraph::stations() const {
  std::vector<std::size_t> marked;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    all.push_back(i);
    if (nodes_[i].station) marked.push_back(i);
  }
  return marked.empty() ? all : marked;
}

std::vector<RouteLeg> RouteGraph::one_way_legs() const {
  std::vector<RouteLeg> found;
  for (const RouteLeg& leg : legs_)
    if (!has_leg(leg.to, leg.from)) found.push_back(leg);
  return found;
}

RouteGraph RouteGraph::symmetric() const {
  std::vector<RouteLeg> legs = legs_;
  for (const RouteLeg& leg : one_way_legs()) legs.push_back({leg.to, leg.from, leg.length_m, leg.line});
  return {nodes_, std::move(legs)};
}

}  // namespace madori::planning
