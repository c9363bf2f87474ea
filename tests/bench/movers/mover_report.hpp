#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/bench/movers/mover_score.hpp"

namespace madori::bench {

/// The two that are compared, of one setup.
struct Comparison {
  std::string setup;
  const MoverScore& tracker;
  const MoverScore& baseline;
  long looks = 0;  ///< scans at which they were compared
};

/// Two Markdown tables, of what is told and of who is found; each cell: the tracker's figure / the
/// baseline's.
void print_told_head();
void print_told(const Comparison& comparison);
void print_found_head();
void print_found(const Comparison& comparison);

[[nodiscard]] nlohmann::json to_json(const MoverScore& score);

}  // namespace madori::bench
