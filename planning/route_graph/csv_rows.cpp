#include "planning/route_graph/csv_rows.hpp"

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

std::vector<std::string> split(std::string_view line, std::string_view separators, bool& quoted) {
  std::vector<std::string> fields(1);
  quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (!quoted && separators.find(c) != std::string_view::npos)
      fields.emplace_back();
    else if (!quoted && c == '#')
      break;
    else
      fields.back() += c;
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

}  // namespace

std::vector<CsvRow> csv_rows(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<CsvRow> rows;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    CsvRow row{line, {}};
    row.fields = split(text.substr(0, end), ";\t", row.open_quote);
    row.decimal_comma = row.fields.size() > 1;
    if (!row.decimal_comma) row.fields = split(text.substr(0, end), ",", row.open_quote);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (row.fields.size() > 1 || !row.fields.front().empty()) rows.push_back(std::move(row));
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
