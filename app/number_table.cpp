#include "app/number_table.hpp"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "core/input_file.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

double number(const std::string& word, const std::string& where) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || !std::isfinite(value)) {
    throw Error(where, "'" + word.substr(0, 40) + "' is not a finite number", "mend or remove the line");
  }
  return value;
}

}  // namespace

std::vector<NumberRow> load_number_table(const std::filesystem::path& file, std::size_t columns) {
  std::ifstream stream(file);
  if (!stream) {
    throw Error(file.string(), std::strerror(errno), "check the file name");
  }
  constexpr std::size_t kMostInLine = 10'000;
  std::vector<NumberRow> rows;
  std::string line;
  for (int n = 1; next_line(stream, line, file.string(), n, kMostInLine); ++n) {
    const std::string where = file.string() + ":" + std::to_string(n);
    std::istringstream words(line.substr(0, line.find('#')));
    NumberRow row{n, {}};
    for (std::string word; words >> word;) {
      row.values.push_back(number(word, where));
    }
    if (!row.values.empty() && row.values.size() != columns) {
      throw Error(where, "has " + std::to_string(row.values.size()) + " columns",
                  "a line has " + std::to_string(columns));
    }
    if (!row.values.empty()) {
      rows.push_back(std::move(row));
    }
  }
  if (rows.empty()) {
    throw Error(file.string(), "holds no rows", "check the file name");
  }
  return rows;
}

}  // namespace madori::app
