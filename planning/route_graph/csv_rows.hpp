#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace madori::planning {

/// A row of a CSV file: its line number in the file and its fields, trimmed, without quotes.
struct CsvRow {
  int line = 0;
  std::vector<std::string> fields;
  bool open_quote = false;     ///< a double quote begins and does not end: the fields cannot be told
  bool decimal_comma = false;  ///< semicolons or tabs separate: a comma is the point of a number
};

/// Splits a CSV text. A byte-order mark, CRLF, blank lines, spaces and `# comments` are tolerated;
/// a field in double quotes may hold commas. A row with semicolons or tabs is separated by these alone
/// (spreadsheets write so, with decimal commas where the country has them). A `#` begins a comment at the
/// beginning of a row, behind the last column, and where no field follows it; elsewhere, and in the column
/// "name", it belongs to its field, so that no field is lost. The columns are the first row's where that
/// begins with no whole number, else `width` of them.
[[nodiscard]] std::vector<CsvRow> csv_rows(std::string_view text, std::size_t width);

/// The whole text as a finite number. The typographic minus sign of printed tables counts as a minus.
[[nodiscard]] std::optional<double> csv_number(std::string_view text, bool decimal_comma = false);
/// The whole text as a whole number.
[[nodiscard]] std::optional<int> csv_integer(std::string_view text);

}  // namespace madori::planning
