// What the commands have in common: numbers within limits, and --json.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

TEST(Within, TakesFiniteNumbersBetweenItsLimitsAlone) {
  const CLI::Validator metres = within(0.5, 2.0);
  for (const char* good : {"0.5", "1", "2.0"}) EXPECT_EQ(metres(good), "") << good;
  for (const char* bad : {"nan", "-nan", "NaN", "inf", "-inf", "0.49", "2.01", "1e400", "two", ""})
    EXPECT_NE(metres(bad), "") << bad;
  EXPECT_NE(within(1, 20)("1.5"), "");
  EXPECT_EQ(metres.get_description(), CLI::Range(0.5, 2.0).get_description());
}

TEST(JsonOutput, AFileThatCannotBeWrittenIsSaidBeforehand) {
  const test::TemporaryFolder folder;
  const auto made = folder.path() / "site";
  for (const std::string& good : {std::string(), std::string("-"), (folder.path() / "a.json").string()})
    EXPECT_NO_THROW(expect_json(good)) << good;
  EXPECT_NO_THROW(expect_json((made / "a.json").string(), made)) << "the command makes this folder";
  EXPECT_THROW(expect_json((made / "a.json").string()), Error);
  EXPECT_THROW(expect_json((folder.path() / "other/a.json").string(), made), Error);
  EXPECT_THROW(expect_json(folder.path().string()), Error);
}

TEST(JsonOutput, EveryFileThatCannotBeWrittenIsSaidBeforehand) {
  const test::TemporaryFolder folder;
  const std::string good = (folder.path() / "a.tum").string(), bad = (folder.path() / "none/a.tum").string();
  EXPECT_NO_THROW(expect_outputs({good, "", good}));
  EXPECT_FALSE(std::filesystem::exists(good));
  EXPECT_THROW(expect_outputs({good, "", bad}), Error);
  EXPECT_NO_THROW(expect_outputs({good, bad}, folder.path() / "none"));
}

/// Whoever reads it has gone.
TEST(JsonOutput, AClosedPipeIsAFailure) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ::close(ends[0]);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  std::cout.flush();
  std::fflush(stdout);
  const int out = ::dup(STDOUT_FILENO);
  ::dup2(ends[1], STDOUT_FILENO);
  const bool ended_before = std::cout.good();
  EXPECT_THROW(write_json("-", {{"a", 1}}), Error);
  std::cout.clear();
  ::dup2(out, STDOUT_FILENO);
  ::close(out);
  ::close(ends[1]);
  std::signal(SIGPIPE, before);
  EXPECT_TRUE(ended_before);
}

TEST(JsonOutput, TextThatIsNotUtf8IsShownAllTheSame) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  write_json(file.string(), {{"drawing", std::string("\xE4.png")}});
  const auto read = nlohmann::json::parse(mapping::file_content(file));
  EXPECT_EQ(read.at("drawing"), "\xEF\xBF\xBD.png");
}

}  // namespace
}  // namespace madori::app
