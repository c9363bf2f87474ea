// Who may include whom: docs/explanation/architecture.md. A new arrow is a decision, made there and here.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Rooms = std::map<std::string, std::set<std::string>>;

const Rooms kMayInclude{
    {"core", {}},
    {"mapping", {"core"}},
    {"io", {"core"}},
    {"sensors", {"core", "io"}},
    {"planning", {"core"}},
    {"control", {"core", "io"}},
    {"localization", {"core", "mapping"}},
    {"simulation", {"core", "io", "mapping", "sensors", "control"}},
    {"hmi", {"core", "mapping", "planning"}},
    {"app", {"core", "io", "mapping", "sensors", "planning", "control", "localization", "simulation", "hmi"}},
};

/// The rooms that the text of one source file of `room` includes although it may not, as "line: room".
std::vector<std::string> forbidden_includes(const std::string& room, std::istream& source) {
  static const std::regex include(R"rx(^\s*#\s*include\s*["<]([a-z_]+)/)rx");
  std::vector<std::string> found;
  std::string line;
  for (int number = 1; std::getline(source, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    const std::string target = match[1];
    if (!kMayInclude.contains(target) || target == room) continue;
    if (!kMayInclude.at(room).contains(target)) found.push_back(std::to_string(number) + ": " + target);
  }
  return found;
}

TEST(Includes, EveryRoomKeepsToItsNeighbours) {
  int files = 0;
  for (const auto& [room, allowed] : kMayInclude) {
    const fs::path folder = fs::path(MADORI_SOURCE_DIR) / room;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
      if (entry.path().string().find("node_modules") != std::string::npos) continue;
      std::ifstream source(entry.path());
      for (const auto& bad : forbidden_includes(room, source))
        ADD_FAILURE() << entry.path() << ':' << bad << " may not be included from " << room;
      ++files;
    }
  }
  EXPECT_GT(files, 10) << "the sources were not found";
}

TEST(Includes, AForbiddenOneIsSeen) {
  std::istringstream source("#include <vector>\n#include \"core/angle.hpp\"\n#include \"app/cycle.hpp\"\n");
  EXPECT_EQ(forbidden_includes("planning", source), std::vector<std::string>{"3: app"});
}

}  // namespace
