// Which files may name a model of lidar: its own folder, the registry and the simulation.
// docs/explanation/lidars.md.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kRooms{"core",    "io",           "mapping", "sensors", "planning",
                                      "control", "localization", "app",     "hmi"};

/// Logs name the formats that others write; a capture is one lidar's by its nature. The command `sim` is the
/// simulation's.
bool may_name(const std::string& file) {
  for (const char* place :
       {"sensors/vlp16/", "sensors/lms1xx/", "sensors/s300/", "sensors/lidar/registry.cpp",
        "sensors/open_log.", "sensors/pcap/", "sensors/rosbag/", "app/commands/sim.cpp"})
    if (file.starts_with(place)) return true;
  return false;
}

/// C++, and the touch panel: its page, its pictures' texts, its tests and the description of its wire.
bool is_source(const fs::path& file) {
  static const std::set<std::string> kinds{".hpp", ".cpp", ".ts",   ".tsx", ".mjs",
                                           ".js",  ".css", ".html", ".json"};
  return kinds.contains(file.extension().string());
}

/// What npm brings or the build makes of the page.
bool is_installed(const std::string& file) {
  return file.find("/node_modules/") != std::string::npos || file.find("/dist/") != std::string::npos;
}

std::vector<int> lines_that_name(std::istream& source) {
  static const std::regex model(R"rx(vlp-?16|lms-?1(xx|\d\d)|\bs-?300\b)rx", std::regex::icase);
  std::vector<int> found;
  std::string line;
  for (int number = 1; std::getline(source, line); ++number)
    if (std::regex_search(line, model)) found.push_back(number);
  return found;
}

TEST(LidarNames, StandInTheRegistryAndTheirOwnFolders) {
  int files = 0;
  for (const std::string& room : kRooms)
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(MADORI_SOURCE_DIR) / room)) {
      const std::string file = fs::relative(entry.path(), MADORI_SOURCE_DIR).string();
      if (!is_source(file) || is_installed(file)) continue;
      ++files;
      if (may_name(file)) continue;
      std::ifstream source(entry.path());
      for (const int line : lines_that_name(source))
        ADD_FAILURE() << file << ':' << line << " names a model of lidar: ask the registry instead";
    }
  EXPECT_GT(files, 300) << "the sources were not found";
}

TEST(LidarNames, AreFound) {
  std::istringstream source("auto a = Vlp16();\nint rows300 = 1;\n// an LMS111\nuse(\"s300\");\n");
  EXPECT_EQ(lines_that_name(source), (std::vector<int>{1, 3, 4}));
}

}  // namespace
