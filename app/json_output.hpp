#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace madori::app {

/// What `--json FILE` promises: `-` is stdout, an empty name nothing, a file is written atomically.
void write_json(const std::string& file, const nlohmann::json& value);

}  // namespace madori::app
