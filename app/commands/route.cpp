#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/plot/localizability_plot.hpp"
#include "app/route_tools.hpp"
#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_check.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "planning/route_graph/route_search.hpp"
#include "planning/route_graph/vehicle_fit.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct RouteArguments {
  std::string site;
  std::string from;
  std::string to;
  std::string metric;
  double spacing_m = 0.1;
  std::string out;
  std::string json_file;
  std::string localizability;
  bool check = false;
  bool symmetric = false;
};

void print_findings(const std::vector<planning::RouteFinding>& findings) {
  constexpr std::size_t kMostPrinted = 20;  // --json holds all of them
  for (std::size_t i = 0; i < std::min(findings.size(), kMostPrinted); ++i)
    std::fprintf(stderr, "%s: %s\n", to_string(findings[i].severity), findings[i].text().c_str());
  if (findings.size() > kMostPrinted)
    std::fprintf(stderr, "... and %zu more\n", findings.size() - kMostPrinted);
}

json findings_json(const std::vector<planning::RouteFinding>& findings) {
  json list = json::array();
  for (const auto& f : findings)
    list.push_back(
        {{"severity", to_string(f.severity)}, {"file", f.file}, {"line", f.line}, {"message", f.message}});
  return list;
}

/// The text goes to stderr where stdout carries the JSON.
std::FILE* text_stream(const RouteArguments& arguments) {
  return arguments.json_file == "-" ? stderr : stdout;
}

void check(const RouteArguments& arguments, const planning::ParsedRoutes& routes) {
  const fs::path folder(arguments.site);
  planning::RouteCheckOptions options;
  options.tree_file = (folder / "routes/tree.csv").string();
  options.path_file = (folder / "routes/path.csv").string();
  std::vector<Segment2<Map>> walls;
  if (fs::exists(folder / "site.yaml")) {
    options.vehicle = planning::outline_of(mapping::load_scaled_site(folder).vehicle);
    for (const auto& wall : mapping::load_walls(folder / "walls.csv")) walls.push_back(wall.segment);
    if (walls.empty())
      throw Error((folder / "walls.csv").string(), "holds no wall to check the routes against",
                  "import the drawing anew");
  }
  std::vector<planning::RouteFinding> findings = routes.findings;
  for (auto& finding : planning::check_routes(routes.graph, walls, options))
    findings.push_back(std::move(finding));
  print_findings(findings);
  const auto errors = std::count_if(findings.begin(), findings.end(),
                                    [](const auto& f) { return f.severity == planning::Severity::Error; });
  write_json(arguments.json_file, {{"findings", findings_json(findings)}, {"errors", errors}});
  if (errors > 0)
    throw Error((folder / "routes").string(), std::to_string(errors) + " fault(s) in the routes",
                "mend the lines above");
  std::fprintf(text_stream(arguments), "routes are good: %zu nodes, %zu legs, %zu drawn walls checked\n",
               routes.graph.nodes().size(), routes.graph.legs().size(), walls.size());
}

/// Writes tree.csv two-way and says which legs were added.
planning::RouteGraph make_symmetric(const RouteArguments& arguments, const planning::RouteGraph& graph) {
  const auto added = graph.one_way_legs();
  planning::RouteGraph both = graph.symmetric();
  if (added.empty()) return both;
  const fs::path file = fs::path(arguments.site) / "routes/tree.csv";
  mapping::write_file_atomically(file, planning::tree_csv(both));
  for (const auto& leg : added)
    std::fprintf(text_stream(arguments), "added the way back %d -> %d\n", graph.nodes()[leg.to].id,
                 graph.nodes()[leg.from].id);
  return both;
}

std::size_t node_named(const planning::RouteGraph& graph, const std::string& name) {
  if (const auto node = graph.find(name)) return *node;
  throw Error("node " + name, "is not in the routes", "madori route DIR --check lists what the files hold");
}

/// How well the site's walls, as far as they are to be believed, will fix the pose along `path`.
json forecast(const RouteArguments& arguments, const Path& path) {
  const fs::path folder(arguments.site);
  (void)mapping::load_scaled_site(folder);
  const mapping::Walls walls = mapping::load_walls(folder / "walls.csv");
  const LearnedDrawing learned = load_learned_drawing(folder, walls);
  const auto map = forecast_localizability(learned.drawing.walls, learned.drawing.weights, path);
  mapping::write_file_atomically(arguments.localizability, localizability_plot(walls, map));
  std::fprintf(text_stream(arguments), "%s\n", describe(map).c_str());
  return to_json(map);
}

/// Routes may stand in a folder that is no site yet.
bool site_wants_shortest(const fs::path& folder) {
  return fs::exists(folder / "site.yaml") && mapping::load_site(folder).shortest_routes;
}

/// A place of the forecast takes about 0.1 ms and a row of the JSON.
void expect_few(const RouteArguments& arguments, double length_m) {
  constexpr double kMostPlaces = 2e5;
  const double most = arguments.localizability.empty() ? planning::kMostWaypoints : kMostPlaces;
  if (!(length_m / arguments.spacing_m <= most))
    throw Error(arguments.site, fmt::format("the way needs more than {:.0f} waypoints", most),
                "choose a wider --spacing, or check the places of the nodes");
}

void search(const RouteArguments& arguments, const planning::RouteGraph& graph) {
  const std::size_t from = node_named(graph, arguments.from);
  const std::size_t to = node_named(graph, arguments.to);
  const bool shortest =
      arguments.metric.empty() ? site_wants_shortest(arguments.site) : arguments.metric == "metres";
  const auto route = planning::find_route(
      graph, from, to, shortest ? planning::RouteMetric::Metres : planning::RouteMetric::Hops);
  if (!route) {
    const auto one_way =
        planning::one_way_warnings(graph, (fs::path(arguments.site) / "routes/tree.csv").string());
    print_findings(one_way);
    throw Error(arguments.site, route.reason(),
                one_way.empty() ? "connect them in routes/tree.csv"
                                : "if the one-way legs are meant both ways: --symmetric");
  }
  planning::WaypointOptions options;
  options.spacing_m = arguments.spacing_m;
  expect_few(arguments, route.value().length_m);
  const auto path = route_path(graph, route.value(), options);
  if (!path && from != to) throw Error(arguments.site, path.reason(), "move the nodes apart");
  std::string names;
  json ids = json::array();
  for (const std::size_t node : route.value().nodes) {
    names += (names.empty() ? "" : " -> ") + std::to_string(graph.nodes()[node].id);
    ids.push_back(graph.nodes()[node].id);
  }
  const std::size_t points = path ? path.value().points.size() : 0;
  std::fprintf(text_stream(arguments), "%s\n%zu legs, %.2f m, %zu waypoints\n", names.c_str(),
               route.value().nodes.size() - 1, route.value().length_m, points);
  if (!arguments.out.empty())
    mapping::write_file_atomically(arguments.out, planning::waypoints_csv(path ? path.value() : Path{}));
  json answer = {{"nodes", ids},
                 {"legs", route.value().nodes.size() - 1},
                 {"length_m", route.value().length_m},
                 {"metric", shortest ? "metres" : "hops"},
                 {"waypoints", points}};
  if (!arguments.localizability.empty())
    answer["localizability"] = forecast(arguments, path ? path.value() : Path{});
  write_json(arguments.json_file, answer);
}

void run(const RouteArguments& arguments) {
  expect_json(arguments.json_file);
  const auto routes = planning::read_routes(fs::path(arguments.site) / "routes");
  if (arguments.check) return check(arguments, routes);
  print_findings(routes.findings);
  if (!routes.good()) throw Error(arguments.site, "the routes have faults", "mend the lines above");
  const auto graph = arguments.symmetric ? make_symmetric(arguments, routes.graph) : routes.graph;
  if (arguments.from.empty() != arguments.to.empty())
    throw CLI::RequiredError("--from and --to stand together");
  if (!arguments.to.empty()) return search(arguments, graph);
  if (!arguments.symmetric) throw CLI::RequiredError("--from and --to, --check, or --symmetric");
}

}  // namespace

void add_route(CLI::App& app) {
  auto arguments = std::make_shared<RouteArguments>();
  auto* command = app.add_subcommand("route", "find a way over the drawn routes, or check them");
  command->add_option("DIR", arguments->site, "site folder")->required();
  command->add_option("--from", arguments->from, "node ID or name");
  command->add_option("--to", arguments->to, "node ID or name");
  command
      ->add_option("--metric", arguments->metric,
                   "hops: fewest legs; metres: shortest way; default: the site's route_metric")
      ->check(CLI::IsMember({"hops", "metres"}));
  command->add_option("--spacing", arguments->spacing_m, "metres between waypoints")
      ->check(within(0.01, 10.0))
      ->capture_default_str();
  command->add_option("--out", arguments->out, "waypoints as CSV (ID,x,y)");
  command->add_option(
      "--localizability", arguments->localizability,
      "picture of how well the drawn walls will fix the position (PNG); with --from and --to");
  command->add_option("--json", arguments->json_file, "the answer as JSON, - for stdout");
  command->add_flag("--check", arguments->check, "find faults in the routes, each with file and line");
  command->add_flag("--symmetric", arguments->symmetric, "make every leg two-way and rewrite tree.csv");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
