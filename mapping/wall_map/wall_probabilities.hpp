#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace madori::mapping {

/// The rows of walls.csv, each with the probability of its wall; as they are where nothing was judged.
[[nodiscard]] std::string with_probabilities(const std::string& rows,
                                             const std::vector<double>& probabilities);

/// The last column of a walls.csv that has one, in the order of its rows; empty otherwise.
[[nodiscard]] std::vector<double> load_probabilities(const std::filesystem::path& walls_csv);

}  // namespace madori::mapping
