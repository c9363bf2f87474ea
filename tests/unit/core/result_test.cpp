#include "core/result.hpp"

#include <gtest/gtest.h>

#include "core/failure_words.hpp"

namespace madori {
namespace {

TEST(Result, HoldsAValueOrAReason) {
  const Result<int> good(7);
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(good.value(), 7);
  const auto bad = Result<int>::failure("no echo");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.reason(), "no echo");
}

TEST(Error, NamesPlaceCauseAndMend) {
  EXPECT_STREQ(Error("plan.png", "it is empty", "export it again").what(),
               "plan.png: it is empty - export it again");
}

TEST(FailureWords, WhatTheSystemRefusesNamesTheFileWhatFailedAndTheRemedy) {
  namespace fs = std::filesystem;
  const auto because = [](std::errc why) { return std::make_error_code(why); };
  EXPECT_EQ(failure_words(fs::filesystem_error("cannot create directories", "site/devices",
                                               because(std::errc::read_only_file_system))),
            "site/devices: cannot create directories: Read-only file system - make the disk writable, or "
            "choose a folder on another one");
  EXPECT_EQ(failure_words(fs::filesystem_error("status", "site/.staging/JOURNAL",
                                               because(std::errc::permission_denied))),
            "site/.staging/JOURNAL: cannot be looked at: Permission denied - give the user who runs this "
            "the right to it, or run this as its owner");
  const std::string thread =
      failure_words(std::system_error(because(std::errc::resource_unavailable_try_again)));
  EXPECT_NE(thread.find(" - end other programs"), std::string::npos) << thread;
  EXPECT_NE(failure_words(std::bad_alloc()).find("not enough"), std::string::npos);
  EXPECT_EQ(failure_words(Error("a", "b", "c")), "a: b - c");
}

}  // namespace
}  // namespace madori
