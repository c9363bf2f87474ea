#include "planning/route_graph/route_csv.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "core/angle.hpp"
#include "core/input_file.hpp"
#include "core/result.hpp"
#include "core/utf8.hpp"
#include "planning/route_graph/csv_rows.hpp"
#include "planning/route_graph/finding_texts.hpp"

namespace madori::planning {
namespace {

constexpr double kFarthestM = 1e6;

/// Collects the faults of one file.
class Findings {
 public:
  Findings(std::string file, std::vector<RouteFinding>& findings)
      : file_(std::move(file)), findings_(findings) {}
  using Values = std::map<std::string, std::string>;
  void error(int line, Fault fault, Values values = {}) {
    findings_.push_back(finding(fault, Severity::Error, file_, line, std::move(values)));
  }
  void warning(int line, Fault fault, Values values = {}) {
    findings_.push_back(finding(fault, Severity::Warning, file_, line, std::move(values)));
  }

 private:
  std::string file_;
  std::vector<RouteFinding>& findings_;
};

/// Column names of path.csv; the published order where the file has no header.
std::map<std::string, std::size_t> take_header(std::vector<CsvRow>& rows, Findings& findings) {
  static const std::set<std::string> known{"ID",      "x",           "y",         "name",
                                           "station", "heading_deg", "speed_mps", "action"};
  std::map<std::string, std::size_t> columns{{"ID", 0}, {"x", 1}, {"y", 2}};
  if (rows.empty() || csv_integer(rows.front().fields.front())) return columns;
  columns.clear();
  const CsvRow& header = rows.front();
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (!known.contains(header.fields[i]))
      findings.error(header.line, Fault::UnknownColumn, {{"column", header.fields[i]}});
    columns.emplace(header.fields[i], i);
  }
  for (const char* needed : {"ID", "x", "y"})
    if (!columns.contains(needed)) findings.error(header.line, Fault::MissingColumn, {{"column", needed}});
  rows.erase(rows.begin());
  return columns;
}

/// The fields of one row of path.csv by column name.
class NodeRow {
 public:
  NodeRow(const CsvRow& row, const std::map<std::string, std::size_t>& columns, Findings& findings)
      : row_(row), columns_(columns), findings_(findings) {}

  [[nodiscard]] std::string text(const std::string& column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() || found->second >= row_.fields.size() ? "" : row_.fields[found->second];
  }
  std::optional<double> number(const std::string& column, double low, double high) {
    const auto value = csv_number(text(column), row_.decimal_comma);
    if (value && *value >= low && *value <= high) return value;
    const auto shown = [](double limit) {
      std::ostringstream digits;
      digits << limit;
      return digits.str();
    };
    fail(Fault::NumberOutOfRange,
         {{"column", column}, {"text", text(column)}, {"low", shown(low)}, {"high", shown(high)}});
    return std::nullopt;
  }
  std::optional<double> optional_number(const std::string& column, double low, double high) {
    return text(column).empty() ? std::nullopt : number(column, low, high);
  }
  /// What no column names would be lost: a decimal comma makes one field more of every number.
  void refuse_surplus() {
    std::size_t width = 0;
    for (const auto& [name, column] : columns_) width = std::max(width, column + 1);
    for (std::size_t i = width; i < row_.fields.size(); ++i)
      if (!row_.fields[i].empty()) return fail(Fault::SurplusField, {{"text", row_.fields[i]}});
  }
  void fail(Fault fault, Findings::Values values) {
    findings_.error(row_.line, fault, std::move(values));
    good_ = false;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  const CsvRow& row_;
  const std::map<std::string, std::size_t>& columns_;
  Findings& findings_;
  bool good_ = true;
};

NodeAction read_action(NodeRow& row) {
  const std::string text = row.text("action");
  if (text.empty()) return NodeAction::None;
  for (const auto& [name, action] : kNodeActions)
    if (text == name) return action;
  row.fail(Fault::UnknownAction, {{"text", text}});
  return NodeAction::None;
}

bool read_station(NodeRow& row) {
  const std::string text = row.text("station");
  if (text == "1" || text == "yes" || text == "true") return true;
  if (!text.empty() && text != "0" && text != "no" && text != "false")
    row.fail(Fault::BadStation, {{"text", text}});
  return false;
}

std::optional<RouteNode> read_node(const CsvRow& csv, const std::map<std::string, std::size_t>& columns,
                                   Findings& findings) {
  NodeRow row(csv, columns, findings);
  row.refuse_surplus();
  RouteNode node;
  const auto id = csv_integer(row.text("ID"));
  if (!id || *id < 0) row.fail(Fault::BadId, {{"text", row.text("ID")}});
  node.id = id.value_or(0);
  node.position.x_m = row.number("x", -kFarthestM, kFarthestM).value_or(0.0);
  node.position.y_m = row.number("y", -kFarthestM, kFarthestM).value_or(0.0);
  node.name = row.text("name");
  node.station = read_station(row);
  if (const auto heading = row.optional_number("heading_deg", -360.0, 360.0))
    node.heading_rad = to_rad(*heading);
  node.speed_limit_mps = row.optional_number("speed_mps", 0.01, 5.0);
  node.action = read_action(row);
  node.line = csv.line;
  if (!row.good()) return std::nullopt;
  return node;
}

std::vector<RouteNode> read_nodes(std::string_view text, Findings findings) {
  std::vector<CsvRow> rows = csv_rows(text, 3);
  const auto columns = take_header(rows, findings);
  std::vector<RouteNode> nodes;
  std::map<int, int> line_of;
  for (const CsvRow& row : rows) {
    if (row.open_quote) {
      findings.error(row.line, Fault::OpenQuote);
      continue;
    }
    auto node = read_node(row, columns, findings);
    if (!node) continue;
    const auto [first, fresh] = line_of.emplace(node->id, node->line);
    if (fresh)
      nodes.push_back(std::move(*node));
    else
      findings.error(row.line, Fault::RepeatedId,
                     {{"node", std::to_string(node->id)}, {"earlier", std::to_string(first->second)}});
  }
  if (nodes.empty()) findings.error(0, Fault::NoNode);
  return nodes;
}

/// Whether a row begins with a number, however it goes on: a header does not.
bool is_numbered(const CsvRow& row) {
  return row.fields.front().find_first_of("0123456789") == 0;
}

/// Legs of one row `ID,EDA`.
void read_neighbours(const CsvRow& row, const std::map<int, std::size_t>& index, Findings& findings,
                     std::vector<RouteLeg>& legs) {
  const auto node_of = [&](const std::string& text) -> std::optional<std::size_t> {
    const auto id = csv_integer(text);
    const auto found = id ? index.find(*id) : index.end();
    if (found != index.end()) return found->second;
    findings.error(row.line, id ? Fault::UnknownNeighbour : Fault::BadNeighbour, {{"text", text}});
    return std::nullopt;
  };
  const auto from = node_of(row.fields.front());
  if (!from) return;
  if (row.fields.size() > 2) findings.error(row.line, Fault::TooManyColumns);
  std::istringstream neighbours(row.fields.size() > 1 ? row.fields[1] : "");
  std::set<std::size_t> seen;
  for (std::string word; neighbours >> word;) {
    const auto to = node_of(word);
    if (!to) continue;
    if (*to == *from)
      findings.warning(row.line, Fault::OwnNeighbour, {{"node", word}});
    else if (!seen.insert(*to).second)
      findings.warning(row.line, Fault::RepeatedNeighbour, {{"node", word}});
    else
      legs.push_back({*from, *to, 0.0, row.line});
  }
}

std::vector<RouteLeg> read_legs(std::string_view text, const std::vector<RouteNode>& nodes,
                                Findings findings) {
  std::map<int, std::size_t> index;
  for (std::size_t i = 0; i < nodes.size(); ++i) index.emplace(nodes[i].id, i);
  std::vector<RouteLeg> legs;
  std::map<int, int> line_of;
  bool first = true;
  for (const CsvRow& row : csv_rows(text, 2)) {
    if (row.open_quote) {
      findings.error(row.line, Fault::OpenQuote);
      continue;
    }
    const auto id = csv_integer(row.fields.front());
    if (std::exchange(first, false) && !is_numbered(row)) continue;  // the header
    if (id) {
      const auto [earlier, fresh] = line_of.emplace(*id, row.line);
      if (!fresh) {
        findings.error(row.line, Fault::RepeatedRow,
                       {{"node", std::to_string(*id)}, {"earlier", std::to_string(earlier->second)}});
        continue;
      }
    }
    read_neighbours(row, index, findings, legs);
  }
  return legs;
}

/// The number of the line, from 1, in which the byte `at` stands.
int line_at(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::ranges::count(text.substr(0, at), '\n'));
}

std::string read_file(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = 16'000'000;
  require_readable(file, kMostBytes, "draw routes on the panel, or write both route files by hand");
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

const char* to_string(Severity severity) {
  return severity == Severity::Error ? "error" : "warning";
}

std::string RouteFinding::text() const {
  return file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + message;
}

bool ParsedRoutes::good() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](auto& f) { return f.severity == Severity::Error; });
}

ParsedRoutes parse_routes(std::string_view tree, std::string_view path, const std::string& tree_file,
                          const std::string& path_file) {
  ParsedRoutes parsed;
  for (const auto& [text, file] : {std::pair(tree, tree_file), std::pair(path, path_file)})
    if (const std::size_t end = utf8_end(text); end < text.size())
      Findings(file, parsed.findings).error(line_at(text, end), Fault::NotText);
  if (!parsed.findings.empty()) return parsed;
  auto nodes = read_nodes(path, Findings(path_file, parsed.findings));
  auto legs = read_legs(tree, nodes, Findings(tree_file, parsed.findings));
  parsed.graph = RouteGraph(std::move(nodes), std::move(legs));
  return parsed;
}

ParsedRoutes read_routes(const std::filesystem::path& folder) {
  const auto tree = folder / "tree.csv";
  const auto path = folder / "path.csv";
  return parse_routes(read_file(tree), read_file(path), tree.string(), path.string());
}

RouteGraph load_routes(const std::filesystem::path& folder) {
  ParsedRoutes parsed = read_routes(folder);
  for (const RouteFinding& finding : parsed.findings)
    if (finding.severity == Severity::Error) throw Error(finding.text());
  return std::move(parsed.graph);
}

}  // namespace madori::planning
