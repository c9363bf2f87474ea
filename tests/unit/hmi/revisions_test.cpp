// What a panel is told of the site's files while somebody changes them.
#include "hmi/server/revisions.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <future>

#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::hmi {
namespace {

mapping::Site hall(const char* name) {
  mapping::Site site;
  site.name = name;
  site.drawing = {"a.png", 400, 240, 1, 0.0};
  site.scale = mapping::ScaleRecord{0.05, "known", 0.0, 0.0, "", {}, {}};
  return site;
}

TEST(Revisions, InTheMiddleOfAChangeTheyAreThoseOfBeforeAndNobodyWaits) {
  const test::TemporaryFolder folder;
  mapping::save_site(folder.path(), hall("before"));
  folder.write("walls.csv", "id,x1,y1,x2,y2\n1,0,0,20,0\n");
  const RevisionWatch watch(folder.path());
  const SiteRevisions before = watch.now();

  // As another command has it that has begun to put its files in place.
  const int lock = ::open((folder.path() / ".staging.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  std::filesystem::create_directories(folder.path() / ".staging");
  folder.write(".staging/JOURNAL", "");
  folder.write("site.yaml", mapping::site_yaml(hall("after")));
  auto asked = std::async(std::launch::async, [&] { return watch.now(); });
  const bool answered = asked.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  EXPECT_TRUE(answered) << "it waits for who changes the site";
  if (answered) {
    EXPECT_EQ(asked.get(), before);
  }

  std::filesystem::remove_all(folder.path() / ".staging");
  ::close(lock);
  const SiteRevisions after = watch.now();
  EXPECT_NE(after.drawing, before.drawing);
  EXPECT_EQ(after.walls, before.walls);
}

}  // namespace
}  // namespace madori::hmi
