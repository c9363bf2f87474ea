#include "planning/route_graph/csv_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace madori::planning {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kTypographicMinus = "\xE2\x88\x92";

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \r\n") - first + 1);
}

struct Columns {
  std::size_t width = 0;
  std::optional<std::size_t> name;  ///< the one column of free text
};

/// Whether nothing is lost when a row ends before the # that its last field meets.
bool ends_here(const std::vector<std::string>& fields, std::string_view rest, std::string_view separators,
               const Columns& columns) {
  if (fields.size() == 1 && trimmed(fields.front()).empty()) return true;
  if (columns.name == fields.size() - 1) return false;
  return fields.size() >= columns.width || rest.find_first_of(separators) == std::string_view::npos;
}

std::vector<std::string> split(std::string_view line, std::string_view separators, const Columns& columns,
                               bool& quoted) {
  std::vector<std::string> fields(1);
  quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"')
      quoted = !quoted;
    else if (!quoted && separators.find(c) != std::string_view::npos)
      fields.emplace_back();
    else if (!quoted && c == '#' && ends_here(fields, line.substr(i), separators, columns))
      break;
    else
      fields.back() += c;
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

/// Whether semicolons or tabs stand between the fields; those of a comment, or of a name's end, do not count.
bool has_semicolons(std::string_view line) {
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == ';' || c == '\t')) return true;
    if (!quoted && c == '#') return false;
  }
  return false;
}

Columns columns_of(const std::vector<std::string>& header) {
  const auto name = std::find(header.begin(), header.end(), "name");
  Columns columns{header.size(), std::nullopt};
  if (name != header.end()) columns.name = static_cast<std::size_t>(name - header.begin());
  return columns;
}

}  // namespace

std::vector<CsvRow> csv_rows(std::string_view text, std::size_t width) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<CsvRow> rows;
  Columns columns{width, std::nullopt};
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view content = text.substr(0, end);
    CsvRow row{line, {}};
    row.decimal_comma = has_semicolons(content);
    row.fields = split(content, row.decimal_comma ? ";\t" : ",", columns, row.open_quote);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (row.fields.size() == 1 && row.fields.front().empty()) continue;
    if (rows.empty() && !csv_integer(row.fields.front())) columns = columns_of(row.fields);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::optional<double> csv_number(std::string_view text, bool decimal_comma) {
  std::string plain;
  if (text.starts_with(kTypographicMinus)) {
    plain.push_back('-');
    text.remove_prefix(kTypographicMinus.size());
  }
  plain.append(text);
  const std::size_t comma = plain.find(',');
  if (decimal_comma && comma != std::string::npos && plain.find('.') == std::string::npos) plain[comma] = '.';
  const char* begin = plain.c_str() + (plain.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, plain.c_str() + plain.size(), value);
  if (error != std::errc() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int> csv_integer(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace madori::planning
