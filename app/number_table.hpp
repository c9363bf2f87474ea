#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace madori::app {

/// The numbers of one line of a text table.
struct NumberRow {
  int line = 0;  ///< counted from 1
  std::vector<double> values;
};

/// A text file of numbers separated by blanks, `columns` a line; `#` starts a comment, empty lines are
/// skipped. Throws Error with file and line on anything else, or when there is no row.
[[nodiscard]] std::vector<NumberRow> load_number_table(const std::filesystem::path& file,
                                                       std::size_t columns);

}  // namespace madori::app
