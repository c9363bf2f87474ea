#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mapping/drawing/import_drawing.hpp"

namespace madori::app {

/// A line on stderr that is written over itself, once the work has taken a second; empty where stderr is no
/// terminal.
[[nodiscard]] mapping::Progress terminal_progress();
/// The figures of `madori import --json`: docs/reference/command-line.md.
[[nodiscard]] nlohmann::json import_json(const mapping::ImportReport& report);
/// The same for a person, on stdout. `site` is the folder as the user named it.
void print_import_summary(const mapping::ImportReport& report, const std::string& site);

}  // namespace madori::app
