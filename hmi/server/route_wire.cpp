#include "hmi/server/route_wire.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "hmi/server/json_text.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
using planning::NodeAction;

std::string action_name(NodeAction action) {
  for (const auto& named : planning::kNodeActions)
    if (named.action == action) return named.name;
  return "";
}

NodeAction action_from(const std::string& name) {
  if (name.empty()) return NodeAction::None;
  for (const auto& named : planning::kNodeActions)
    if (name == named.name) return named.action;
  throw Error("action \"" + name + "\"", "is not known", "use load, unload, door or lift");
}

/// A name stands in a CSV field on one line.
std::string clean_name(const std::string& name) {
  std::string clean;
  for (const char c : name)
    if (static_cast<unsigned char>(c) >= 0x20 && c != '"') clean.push_back(c);
  return clean;
}

planning::RouteNode node_from(const json& wire) {
  planning::RouteNode node;
  node.id = whole_number<int>(wire.at("id"));
  node.position = {wire.at("x").get<double>(), wire.at("y").get<double>()};
  if (node.id < 0 || !std::isfinite(node.position.x_m + node.position.y_m))
    throw Error("node " + std::to_string(node.id), "has no valid number or place", "draw it again");
  node.name = clean_name(wire.at("name").get<std::string>());
  node.station = wire.at("station").get<bool>();
  if (!wire.at("heading_deg").is_null()) node.heading_rad = to_rad(wire["heading_deg"].get<double>());
  if (!wire.at("speed_mps").is_null()) node.speed_limit_mps = wire["speed_mps"].get<double>();
  if (node.speed_limit_mps && !(*node.speed_limit_mps > 0.0))
    throw Error("node " + std::to_string(node.id), "has a speed limit that lets nothing move",
                "leave it empty or raise it");
  node.action = action_from(wire.at("action").get<std::string>());
  return node;
}

}  // namespace

planning::RouteGraph graph_from_wire(const json& edit) {
  std::vector<planning::RouteNode> nodes;
  std::unordered_map<int, std::size_t> index;
  for (const auto& wire : edit.at("nodes")) {
    nodes.push_back(node_from(wire));
    if (!index.emplace(nodes.back().id, nodes.size() - 1).second)
      throw Error("node " + std::to_string(nodes.back().id), "stands twice in the routes",
                  "remove one of them");
  }
  std::vector<planning::RouteLeg> legs;
  for (const auto& wire : edit.at("legs")) {
    const auto from = index.find(whole_number<int>(wire.at(0)));
    const auto to = index.find(whole_number<int>(wire.at(1)));
    if (from == index.end() || to == index.end())
      throw Error("leg " + wire.dump(), "joins a point that is not there", "draw it again");
    legs.push_back({from->second, to->second, 0.0, 0});
  }
  return {std::move(nodes), std::move(legs)};
}

json routes_to_wire(const planning::RouteGraph& graph, const std::vector<planning::RouteFinding>& findings,
                    const std::string& revision) {
  json nodes = json::array();
  for (const auto& n : graph.nodes()) {
    json node{{"id", n.id},           {"x", n.position.x_m},
              {"y", n.position.y_m},  {"name", n.name},
              {"station", n.station}, {"heading_deg", nullptr},
              {"speed_mps", nullptr}, {"action", action_name(n.action)}};
    if (n.heading_rad) node["heading_deg"] = std::round(to_deg(*n.heading_rad) * 1e6) / 1e6;
    if (n.speed_limit_mps) node["speed_mps"] = *n.speed_limit_mps;
    nodes.push_back(std::move(node));
  }
  json legs = json::array();
  for (const auto& leg : graph.legs()) legs.push_back({graph.nodes()[leg.from].id, graph.nodes()[leg.to].id});
  json list = json::array();
  for (const auto& f : findings)
    list.push_back({{"severity", to_string(f.severity)},
                    {"file", f.file},
                    {"line", f.line},
                    {"message", f.message},
                    {"code", f.code},
                    {"values", f.values}});
  return {{"revision", revision}, {"nodes", nodes}, {"legs", legs}, {"findings", list}};
}

}  // namespace madori::hmi
