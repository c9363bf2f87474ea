#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace madori::app {

/// Throws Error where one of the files cannot be written, to be called before a command does its work or
/// changes anything. Inside `made`, a folder that the command may still have to make, nothing can be said
/// yet; an empty name is none.
void expect_outputs(std::initializer_list<std::string> files, const std::filesystem::path& made = {});

/// The same of write_json(file).
void expect_json(const std::string& file, const std::filesystem::path& made = {});

/// What `--json FILE` promises: `-` is stdout, an empty name nothing, a file is written atomically.
/// Text that is not UTF-8 (a file's name) is shown with U+FFFD. Throws Error where it cannot be written, to
/// stdout too.
void write_json(const std::string& file, const nlohmann::json& value);

}  // namespace madori::app
