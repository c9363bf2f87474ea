// One clock: the time of day is read in core/clock.hpp alone, and what devices say is stamped by that clock.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::regex kTimeOfDay(
    R"(system_clock|[^_a-z]time\((nullptr|NULL|0)\)|gettimeofday|CLOCK_REALTIME|CURRENT_TIMESTAMP|utc_clock)");
const std::regex kAnotherClock(R"(steady_clock|CLOCK_MONOTONIC|high_resolution_clock)");

/// "file:line" of everything that matches in the sources below `folder` of the project.
std::vector<std::string> places(const std::string& folder, const std::regex& what) {
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(MADORI_SOURCE_DIR) / folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
    std::ifstream source(entry.path());
    std::string line;
    for (int number = 1; std::getline(source, line); ++number)
      if (std::regex_search(line, what))
        found.push_back(entry.path().lexically_relative(MADORI_SOURCE_DIR).string() + ":" +
                        std::to_string(number));
  }
  return found;
}

TEST(Clocks, TheTimeOfDayIsReadInOnePlace) {
  int allowed = 0;
  for (const char* room : {"core", "io", "mapping", "sensors", "planning", "control", "localization",
                           "simulation", "hmi", "app"})
    for (const auto& place : places(room, kTimeOfDay)) {
      const bool known = place.starts_with("core/clock.hpp:") || place.starts_with("core/stamp.hpp:");
      EXPECT_TRUE(known) << place << ": ask core/clock.hpp for the time";
      allowed += known ? 1 : 0;
    }
  EXPECT_GE(allowed, 2) << "the sources were not found";
}

TEST(Clocks, WhatDevicesSayIsStampedByTheClockOfTheCycle) {
  for (const char* room : {"io", "sensors", "control", "planning", "localization", "app/cycle"})
    for (const auto& place : places(room, kAnotherClock))
      ADD_FAILURE() << place << ": a second clock; use clock_now()";
}

TEST(Clocks, OthersAreSeen) {
  EXPECT_TRUE(std::regex_search("  auto t = std::chrono::system_clock::now();", kTimeOfDay));
  EXPECT_TRUE(std::regex_search("  const std::time_t now = std::time(nullptr);", kTimeOfDay));
  EXPECT_FALSE(std::regex_search("  const Stamp now = clock_now();", kTimeOfDay));
}

}  // namespace
