#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace madori::planning {

/// A row of a CSV file: its line number in the file and its fields, trimmed, without quotes.
struct CsvRow {
  int line = 0;
  std::vector<std::string> fields;
  bool open_quote = false;  ///< a double quote begins and does not end: the fields cannot be told
};

/// Splits a CSV text. A byte-order mark, CRLF, blank lines, spaces and `# comments` are tolerated;
/// a field in double quotes may hold commas. Tabs and semicolons separate too (spreadsheets write them).
[[nodiscard]] std::vector<CsvRow> csv_rows(std::string_view text);

/// The whole text as a finite number. The typographic minus sign of printed tables counts as a minus.
[[nodiscard]] std::optional<double> csv_number(std::string_view text);
/// The whole text as a whole number.
[[nodiscard]] std::optional<int> csv_integer(std::string_view text);

}  // namespace madori::planning
