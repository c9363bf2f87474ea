#include <algorithm>
#include <array>
#include <charconv>

#include "core/angle.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::planning {
namespace {

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string quoted(const std::string& text) {
  return text.find_first_of(",;\t#") == std::string::npos ? text : '"' + text + '"';
}

const char* action_name(NodeAction action) {
  const auto* found =
      std::find_if(kNodeActions.begin(), kNodeActions.end(), [&](auto& a) { return a.action == action; });
  return found == kNodeActions.end() ? "" : found->name;
}

struct OptionalColumn {
  const char* name;
  std::string (*text)(const RouteNode&);
};
const std::array<OptionalColumn, 5> kOptionalColumns{{
    {"name", [](const RouteNode& n) { return quoted(n.name); }},
    {"station", [](const RouteNode& n) { return std::string(n.station ? "1" : ""); }},
    {"heading_deg",
     [](const RouteNode& n) { return n.heading_rad ? number_text(to_deg(*n.heading_rad)) : ""; }},
    {"speed_mps",
     [](const RouteNode& n) { return n.speed_limit_mps ? number_text(*n.speed_limit_mps) : ""; }},
    {"action", [](const RouteNode& n) { return std::string(action_name(n.action)); }},
}};

}  // namespace

std::string tree_csv(const RouteGraph& graph) {
  std::string text = "ID,EDA\n";
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    text += std::to_string(graph.nodes()[i].id);
    char separator = ',';
    for (const RouteLeg& leg : graph.legs_from(i)) {
      text += separator + std::to_string(graph.nodes()[leg.to].id);
      separator = ' ';
    }
    text += separator == ',' ? ",\n" : "\n";
  }
  return text;
}

std::string path_csv(const RouteGraph& graph) {
  std::vector<const OptionalColumn*> used;
  for (const OptionalColumn& column : kOptionalColumns)
    if (std::any_of(graph.nodes().begin(), graph.nodes().end(),
                    [&](auto& n) { return !column.text(n).empty(); }))
      used.push_back(&column);
  std::string text = "ID,x,y";
  for (const auto* column : used) text += std::string(",") + column->name;
  text += '\n';
  for (const RouteNode& node : graph.nodes()) {
    text +=
        std::to_string(node.id) + ',' + number_text(node.position.x_m) + ',' + number_text(node.position.y_m);
    for (const auto* column : used) text += ',' + column->text(node);
    text += '\n';
  }
  return text;
}

}  // namespace madori::planning
