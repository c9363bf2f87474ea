#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::planning {

/// What a vehicle does at a node beside passing it.
enum class NodeAction { None, Load, Unload, Door, Lift };

/// Whether something there may be shut, or not open high enough.
[[nodiscard]] constexpr bool is_door(NodeAction action) {
  return action == NodeAction::Door || action == NodeAction::Lift;
}

/// What path.csv calls an action.
struct NamedAction {
  const char* name;
  NodeAction action;
};
inline constexpr std::array<NamedAction, 4> kNodeActions{{{"load", NodeAction::Load},
                                                          {"unload", NodeAction::Unload},
                                                          {"door", NodeAction::Door},
                                                          {"lift", NodeAction::Lift}}};

/// A node of the routes: path.csv of the layout-map paper (Table 3), and its optional extra columns.
struct RouteNode {
  int id = 0;
  Point2<Map> position;
  std::string name;                       ///< what operators call it; empty where the file has none
  bool station = false;                   ///< orders may end here
  std::optional<double> heading_rad;      ///< how the vehicle shall stand here, Map frame
  std::optional<double> speed_limit_mps;  ///< of every leg that begins or ends here
  NodeAction action = NodeAction::None;
  int line = 0;  ///< of path.csv, for messages
};

/// The way from one node to a neighbour; `from` and `to` count in RouteGraph::nodes().
struct RouteLeg {
  std::size_t from = 0;
  std::size_t to = 0;
  double length_m = 0.0;
  int line = 0;  ///< of tree.csv, for messages
};

/// Nodes and directed legs. A leg that stands on one side of tree.csv only is one-way.
class RouteGraph {
 public:
  RouteGraph() = default;
  /// Lengths are computed here. Preconditions: IDs are unique, legs point at nodes.
  RouteGraph(std::vector<RouteNode> nodes, std::vector<RouteLeg> legs);

  [[nodiscard]] const std::vector<RouteNode>& nodes() const { return nodes_; }
  /// Sorted by `from`; neighbours of one node in the order of the file.
  [[nodiscard]] const std::vector<RouteLeg>& legs() const { return legs_; }
  [[nodiscard]] std::span<const RouteLeg> legs_from(std::size_t node) const;
  [[nodiscard]] bool has_leg(std::size_t from, std::size_t to) const;
  [[nodiscard]] std::optional<std::size_t> index_of(int id) const;
  /// By ID ("4") or by name ("Press 2").
  [[nodiscard]] std::optional<std::size_t> find(const std::string& id_or_name) const;
  /// Stations; every node where the file marks none.
  [[nodiscard]] std::vector<std::size_t> stations() const;
  /// Legs without a way back.
  [[nodiscard]] std::vector<RouteLeg> one_way_legs() const;
  /// The same routes with every leg two-way.
  [[nodiscard]] RouteGraph symmetric() const;

 private:
  std::vector<RouteNode> nodes_;
  std::vector<RouteLeg> legs_;
  std::vector<std::size_t> first_leg_;  ///< nodes + 1 entries
  std::unordered_map<int, std::size_t> index_;
};

}  // namespace madori::planning
