// Measures drawings once, so that training takes seconds.
//   measure_sheets LIST FOLDER
// writes FOLDER/NAME.sheet for every row of LIST (example_sheet.hpp) that is not there yet.
#include <cstdio>
#include <filesystem>

#include "tests/bench/wall_training/example_sheet.hpp"

int main(int count, char** words) try {
  if (count != 3) {
    std::fprintf(stderr, "measure_sheets LIST FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = words[2];
  std::filesystem::create_directories(folder);
  for (const auto& row : madori::training::read_list(words[1])) {
    const auto file = folder / (row.name + ".sheet");
    if (std::filesystem::exists(file)) continue;
    const auto sheet = madori::training::measure(row);
    madori::training::save(sheet, file);
    std::printf("%s: %zu edges\n", row.name.c_str(), sheet.rows());
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "measure_sheets: %s\n", error.what());
  return 1;
}
