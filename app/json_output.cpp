#include "app/json_output.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "mapping/site/atomic_file.hpp"

namespace madori::app {

void write_json(const std::string& file, const nlohmann::json& value) {
  if (file.empty()) return;
  if (file == "-")
    std::cout << value.dump(2) << '\n';
  else
    mapping::write_file_atomically(file, value.dump(2) + "\n");
}

}  // namespace madori::app
