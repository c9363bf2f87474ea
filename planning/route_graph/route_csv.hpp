#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "planning/route_graph/route_graph.hpp"

namespace madori::planning {

enum class Severity { Warning, Error };
[[nodiscard]] const char* to_string(Severity severity);  ///< "warning", "error"

/// Something that is wrong, or worth knowing, about the route files.
struct RouteFinding {
  Severity severity = Severity::Error;
  std::string file;
  int line = 0;         ///< 0 where it concerns the whole file
  std::string message;  ///< in English
  std::string code;     ///< of finding_texts.hpp: what the panel's catalogues know it by
  std::map<std::string, std::string> values;

  /// "routes/tree.csv:3: message"
  [[nodiscard]] std::string text() const;
};

struct ParsedRoutes {
  RouteGraph graph;  ///< what could be read; complete where no finding is an Error
  std::vector<RouteFinding> findings;

  [[nodiscard]] bool good() const;
};

/// Reads the two tables of the layout-map paper (section 3.3, Tables 2 and 3): `ID,EDA` with neighbours
/// separated by spaces, and `ID,x,y` in metres, Map frame. Optional columns of path.csv, by header: name,
/// station, heading_deg, speed_mps, action. All faults are collected. The file names are for messages.
[[nodiscard]] ParsedRoutes parse_routes(std::string_view tree, std::string_view path,
                                        const std::string& tree_file = "tree.csv",
                                        const std::string& path_file = "path.csv");

/// `folder`/tree.csv and `folder`/path.csv, with all findings; throws Error only where a file is not
/// readable.
[[nodiscard]] ParsedRoutes read_routes(const std::filesystem::path& folder);
/// The same; throws the first Error finding.
[[nodiscard]] RouteGraph load_routes(const std::filesystem::path& folder);

/// The text of tree.csv and of path.csv; optional columns stand where a node uses them.
[[nodiscard]] std::string tree_csv(const RouteGraph& graph);
[[nodiscard]] std::string path_csv(const RouteGraph& graph);

}  // namespace madori::planning
