#include "mapping/wall_map/wall_probabilities.hpp"

#include <fstream>
#include <sstream>

namespace madori::mapping {

std::string with_probabilities(const std::string& rows, const std::vector<double>& probabilities) {
  if (probabilities.empty()) return rows;
  std::istringstream in(rows);
  std::ostringstream out;
  out.precision(3);
  std::string row;
  for (std::size_t i = 0; std::getline(in, row); ++i) {
    out << row << ',';
    i == 0 ? out << "probability\n" : out << probabilities.at(i - 1) << '\n';
  }
  return out.str();
}

std::vector<double> load_probabilities(const std::filesystem::path& walls_csv) {
  std::ifstream stream(walls_csv);
  std::string row;
  std::getline(stream, row);
  if (row.find("probability") == std::string::npos) return {};
  std::vector<double> probabilities;
  while (std::getline(stream, row))
    if (const std::size_t comma = row.rfind(','); comma != std::string::npos)
      probabilities.push_back(std::stod(row.substr(comma + 1)));
  return probabilities;
}

}  // namespace madori::mapping
