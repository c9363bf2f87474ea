#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace madori::bench {

/// What the columns mean, and their names.
void print_head();
/// One line of the table from the figures of a start (DriveFigures as JSON).
void print_row(const nlohmann::json& figures);
/// A line a building, and one over all.
void print_sums(const std::vector<nlohmann::json>& starts);
/// The same columns and more, a line a start.
[[nodiscard]] std::string to_csv(const std::vector<nlohmann::json>& starts);

}  // namespace madori::bench
