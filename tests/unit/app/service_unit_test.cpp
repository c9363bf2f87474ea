#include "app/runner/service_unit.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

TEST(ServiceUnit, NothingInANameIsReplacedOrSplit) {
  EXPECT_EQ(quoted_for_systemd("/srv/hall 2"), "\"/srv/hall 2\"");
  EXPECT_EQ(quoted_for_systemd("100%$HOME\"\\"), "\"100%%$$HOME\\\"\\\\\"");
  EXPECT_THROW((void)quoted_for_systemd("two\nlines"), Error);
}

TEST(ServiceUnit, SystemdTakesItWithoutAWarning) {
  if (std::system("systemd-analyze --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no systemd-analyze here";
  const test::TemporaryFolder folder;
  const auto site = folder.path() / "hall 2 (100%)";
  std::filesystem::create_directories(site);
  const std::string unit = service_unit({site, "/bin/true", "root", {"--hmi", "0.0.0.0:8080"}});
  std::ofstream(folder.path() / "madori.service") << unit;
  const auto log = folder.path() / "log.txt";
  const std::string command = "cd " + folder.path().string() +
                              " && systemd-analyze verify --man=no ./madori.service > " + log.string() +
                              " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream in(log);
  const std::string said((std::istreambuf_iterator<char>(in)), {});
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(said, "");
}

}  // namespace
}  // namespace madori::app
