#include "mapping/site/site_versions.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_transaction.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

void save(const std::filesystem::path& site, int number) {
  SiteTransaction change(site);
  const std::string text = std::string(20'000, 'x') + std::to_string(number);
  change.write("routes/tree.csv", "tree " + text);
  change.write("routes/path.csv", "path " + text);
  change.commit();
}

class SiteVersionsTest : public testing::Test {
 protected:
  [[nodiscard]] std::string now(const char* name) const { return file_content(site_ / "routes" / name); }

  test::TemporaryFolder folder_;
  std::filesystem::path site_ = folder_.path() / "site";
};

TEST_F(SiteVersionsTest, EverySaveIsOneAndAnyCanBeBroughtBack) {
  for (int i = 1; i <= 3; ++i) save(site_, i);
  const std::string third = now("tree.csv");
  const auto versions = site_versions(site_);
  ASSERT_EQ(versions.size(), 3U);
  EXPECT_EQ(versions[1].sentence, "routes");
  EXPECT_GT(versions[1].stamp_s, 1e9);
  restore_version(site_, 1);
  EXPECT_EQ(now("tree.csv").back(), '1');
  EXPECT_EQ(site_versions(site_).size(), 4U);
  restore_version(site_, 3);
  EXPECT_EQ(now("tree.csv"), third);
  save(site_, 3);  // nothing has changed: no version
  EXPECT_EQ(site_versions(site_).size(), 5U);
}

/// A drawing was laid over a map by driving, and the map is brought back; then the drawing.
TEST_F(SiteVersionsTest, TheWayThatWasDrivenGoesAndComesWithItsMap) {
  {
    SiteTransaction change(site_);
    change.write(kWayFile, "of the map");
    change.commit();
  }
  {
    SiteTransaction change(site_);
    change.remove(kWayFile);
    change.write("routes/tree.csv", "of the drawing");
    change.commit();
  }
  restore_version(site_, 1);
  EXPECT_EQ(file_content(site_ / kWayFile), "of the map");
  restore_version(site_, 2);
  EXPECT_FALSE(std::filesystem::exists(site_ / kWayFile));
}

TEST_F(SiteVersionsTest, WhatAnotherProgramSavedIsKeptBeforeTheNextSave) {
  save(site_, 1);
  std::ofstream(site_ / "routes/tree.csv") << "by hand";
  save(site_, 2);
  const auto versions = site_versions(site_);
  ASSERT_EQ(versions.size(), 3U);
  EXPECT_EQ(version_file(site_, versions[1], "routes/tree.csv"), "by hand");
}

TEST_F(SiteVersionsTest, WhatIsNotAsItWasKeptIsNotRestored) {
  save(site_, 1);
  save(site_, 2);
  const auto object = site_ / "versions/objects" / site_versions(site_)[0].files.at("routes/tree.csv");
  for (const bool lost : {false, true}) {
    lost ? (void)std::filesystem::remove(object) : (void)(std::ofstream(object) << "of a disk that errs");
    EXPECT_THROW(restore_version(site_, 1), Error);
    EXPECT_EQ(site_versions(site_).size(), 2U);
    EXPECT_EQ(now("tree.csv"), version_file(site_, site_versions(site_)[1], "routes/tree.csv"));
  }
}

/// A save that was cut off has either happened with its version, or not at all.
TEST_F(SiteVersionsTest, KillsAtAnyMomentLoseNoVersionAndLeaveNoneHalf) {
  std::mt19937 random(5);
  save(site_, 0);
  std::size_t known = 1;
  for (int kill = 0; kill < 40; ++kill) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int i = 1;; ++i) i % 5 == 4 ? restore_version(site_, 1) : save(site_, 1000 * kill + i);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 40'000));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    recover_site(site_);
    const auto versions = site_versions(site_);
    ASSERT_GE(versions.size(), known);
    known = versions.size();
    for (std::size_t i = 0; i < versions.size(); ++i) {
      ASSERT_EQ(versions[i].number, static_cast<int>(i) + 1);
      const auto tree = version_file(site_, versions[i], "routes/tree.csv");
      ASSERT_EQ(tree.substr(4), version_file(site_, versions[i], "routes/path.csv").substr(4));
    }
    ASSERT_EQ(now("tree.csv"), version_file(site_, versions.back(), "routes/tree.csv"));
  }
}

/// As a backup of another computer may bring it.
TEST_F(SiteVersionsTest, AManifestThatNamesWhatNoVersionKeepsIsLeftOut) {
  save(site_, 1);
  const std::string object = site_versions(site_)[0].files.at("routes/tree.csv");
  const auto add = [&](const std::string& number, const std::string& name, const std::string& of) {
    write_new_file(site_ / "versions/000007.json",
                   "{\"number\":" + number +
                       ",\"stamp_s\":1,\"author\":\"\",\"sentence\":\"\",\"files\":{\"" + name + "\":\"" +
                       of + "\"}}");
    return site_versions(site_).size();
  };
  EXPECT_EQ(add("7", "drawing.png", object), 2U);
  EXPECT_EQ(add("7", "drawing./../../beside", object), 1U);
  EXPECT_EQ(add("7", "pins", object), 1U);
  EXPECT_EQ(add("7", "drawing.png", "../../site.yaml"), 1U);
  EXPECT_EQ(add("2147483647", "drawing.png", object), 1U);  // has no number after it
  EXPECT_EQ(add("1e300", "drawing.png", object), 1U);
}

}  // namespace
}  // namespace madori::mapping
