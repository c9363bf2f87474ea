#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace madori::app {

/// Throws Error where write_json(file) would fail, to be called before a command changes anything. Inside
/// `made`, a folder that the command may still have to make, nothing can be said yet.
void expect_json(const std::string& file, const std::filesystem::path& made = {});

/// What `--json FILE` promises: `-` is stdout, an empty name nothing, a file is written atomically.
/// Text that is not UTF-8 (a file's name) is shown with U+FFFD. Throws Error where it cannot be written, to
/// stdout too.
void write_json(const std::string& file, const nlohmann::json& value);

}  // namespace madori::app
