#include "app/json_output.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::app {

void expect_outputs(std::initializer_list<std::string> files, const std::filesystem::path& made) {
  namespace fs = std::filesystem;
  for (const std::string& file : files) {
    if (file.empty()) continue;
    const fs::path folder = fs::weakly_canonical(fs::absolute(file).parent_path());
    const bool is_made = !made.empty() && folder == fs::weakly_canonical(fs::absolute(made));
    if (!is_made || fs::exists(folder)) mapping::expect_writable(file);
  }
}

void expect_json(const std::string& file, const std::filesystem::path& made) {
  if (file != "-") expect_outputs({file}, made);
}

void write_json(const std::string& file, const nlohmann::json& value) {
  if (file.empty()) return;
  const std::string text = value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (file != "-") return mapping::write_file_atomically(file, text);
  if (!(std::cout << text << std::flush))
    throw Error("standard output", "could not be written to its end",
                "make room where it goes, or let it be read to its end");
}

}  // namespace madori::app
