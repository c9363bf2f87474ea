#include "mapping/site/site_transaction.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

TEST(SiteTransaction, ChangesNothingWithoutCommit) {
  const test::TemporaryFolder folder;
  folder.write("walls.csv", "old");
  {
    SiteTransaction change(folder.path());
    change.write("walls.csv", "new");
    change.remove("walls.csv");
  }
  EXPECT_EQ(file_content(folder.path() / "walls.csv"), "old");
  EXPECT_FALSE(fs::exists(folder.path() / ".staging"));
}

TEST(SiteTransaction, RemovesTheFolderItMadeWhenItIsGivenUp) {
  const test::TemporaryFolder folder;
  { SiteTransaction change(folder.path() / "site"); }
  EXPECT_FALSE(fs::exists(folder.path() / "site"));
}

TEST(SiteTransaction, CommitsPutsAndRemovals) {
  const test::TemporaryFolder folder;
  folder.write("drawing.png", "old");
  SiteTransaction change(folder.path());
  change.write("drawing.pdf", "new");
  change.write("routes/tree.csv", "ID,EDA\n");
  change.remove("drawing.png");
  change.commit();
  EXPECT_EQ(file_content(folder.path() / "drawing.pdf"), "new");
  EXPECT_EQ(file_content(folder.path() / "routes/tree.csv"), "ID,EDA\n");
  EXPECT_FALSE(fs::exists(folder.path() / "drawing.png"));
}

/// People link what several sites share, and routes that lie on another disk.
TEST(SiteTransaction, ALinkStaysAndTheFileItLeadsToIsReplaced) {
  const test::TemporaryFolder folder, elsewhere;
  elsewhere.write("routes.csv", "old");
  fs::create_directories(folder.path() / "routes");
  const fs::path link = folder.path() / "routes/tree.csv", target = elsewhere.path() / "routes.csv";
  fs::create_symlink(target, link);
  {
    SiteTransaction change(folder.path());
    change.write("routes/tree.csv", "new");
    change.commit();
  }
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(file_content(target), "new");
  EXPECT_FALSE(fs::exists(folder.path() / ".staging"));
  fs::remove(link);
  fs::create_symlink(elsewhere.path() / "nowhere/routes.csv", link);
  SiteTransaction change(folder.path());
  change.write("routes/tree.csv", "newer");
  EXPECT_THROW(change.commit(), Error) << "what was committed could not come to pass";
  EXPECT_FALSE(fs::exists(folder.path() / ".staging/JOURNAL"));
}

/// A person has to find the file that is meant.
TEST(SiteTransaction, WhatItRefusesIsSaidOfTheSitesOwnFile) {
  const test::TemporaryFolder folder;
  SiteTransaction change(folder.path());
  change.write("site.yaml", "madori_site: 1\nname: [a]\n");
  try {
    change.commit();
    FAIL() << "it was taken";
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find(".staging"), std::string::npos) << e.what();
    EXPECT_TRUE(std::string(e.what()).starts_with((folder.path() / "site.yaml").string())) << e.what();
  }
}

TEST(SiteTransaction, RefusesASecondWriter) {
  const test::TemporaryFolder folder;
  const SiteTransaction first(folder.path());
  EXPECT_THROW(SiteTransaction second(folder.path()), Error);
}

/// Power fails after the journal was written and one of two files was moved.
TEST(SiteTransaction, FinishesACommitThatWasCutShort) {
  const test::TemporaryFolder folder;
  folder.write("a", "new a");  // moved already
  folder.write("b", "old b");
  folder.write("c", "old c");
  fs::create_directory(folder.path() / ".staging");
  folder.write(".staging/b", "new b");
  folder.write(".staging/JOURNAL", "- c\n+ a\n+ b\n");
  recover_site(folder.path());
  EXPECT_EQ(file_content(folder.path() / "a"), "new a");
  EXPECT_EQ(file_content(folder.path() / "b"), "new b");
  EXPECT_FALSE(fs::exists(folder.path() / "c"));
  EXPECT_FALSE(fs::exists(folder.path() / ".staging"));
}

/// The disk refuses the last step of a commit that was cut short. Who tries again, in the same program, is
/// neither refused for its own lock nor waits for it.
TEST(SiteTransaction, AChangeThatCannotBeFinishedKeepsNoLock) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.path() / ".staging");
  fs::create_directories(folder.path() / "walls.csv" / "in the way");
  folder.write(".staging/walls.csv", "new");
  folder.write(".staging/JOURNAL", "+ walls.csv\n");
  EXPECT_THROW(SiteTransaction(folder.path()), fs::filesystem_error);
  EXPECT_THROW(recover_site(folder.path()), fs::filesystem_error);
  fs::remove_all(folder.path() / "walls.csv");
  { SiteTransaction change(folder.path()); }
  EXPECT_EQ(file_content(folder.path() / "walls.csv"), "new");
}

TEST(SiteTransaction, ANameThatLeavesTheSiteOrEndsALineOfItsJournalIsRefused) {
  const test::TemporaryFolder folder;
  const fs::path beside = folder.write("beside", "untouched");
  SiteTransaction change(folder.path() / "site");
  for (const std::string& name : {"tiles/a\n- " + beside.string(), std::string("../beside"), beside.string(),
                                  std::string("tiles/../../beside"), std::string("tiles/"), std::string()}) {
    EXPECT_THROW(change.write(name, "x"), Error) << name;
    EXPECT_THROW(change.remove(name), Error) << name;
  }
  change.write("tiles/a", "x");
  change.commit();
  EXPECT_EQ(file_content(beside), "untouched");
}

/// Likewise: a rename to another disk fails, and would at every later command.
TEST(SiteTransaction, AFolderThatIsALinkToNothingOrToAnotherDiskIsToldWithTheSiteAsItWas) {
  const test::TemporaryFolder folder;
  const fs::path site = folder.path() / "site",
                 other = "/dev/shm/madori-" + folder.path().filename().string();
  fs::create_directories(site);
  const bool is_other = fs::create_directory(other) && ::access(other.c_str(), W_OK) == 0;
  for (const fs::path& to : {folder.path() / "unmounted", other}) {
    if (to == other && !is_other) continue;
    fs::create_symlink(to, site / "routes");
    {
      SiteTransaction change(site);
      change.write("note.txt", "new");
      change.write("routes/tree.csv", "ID,EDA\n0,0\n");
      EXPECT_THROW(change.commit(), Error) << to;
    }
    EXPECT_FALSE(fs::exists(site / "note.txt")) << to;
    EXPECT_FALSE(is_being_changed(site)) << to;
    EXPECT_NO_THROW(recover_site(site)) << to;
    fs::remove(site / "routes");
  }
  fs::remove_all(other);
}

/// Before the commit, not half way through it.
TEST(SiteTransaction, WhatIsInTheWayOfAFileIsToldWithTheSiteAsItWas) {
  const test::TemporaryFolder folder;
  const auto save = [&](const char* name) {
    SiteTransaction change(folder.path());
    change.write("walls.csv.old", name);
    change.write(name, "x");
    change.commit();
  };
  save("tiles/18/5.png");
  for (const char* name : {"tiles/18", "tiles/18/5.png/7"}) {
    EXPECT_THROW(save(name), Error) << name;
    EXPECT_EQ(file_content(folder.path() / "walls.csv.old"), "tiles/18/5.png");
  }
  save("tiles/19");  // nothing was left undone
}

TEST(SiteTransaction, SurvivesKillAtAnyMoment) {
  const test::TemporaryFolder folder;
  folder.write("a", "0");
  folder.write("b", "0");
  for (int turn = 1; turn <= 40; ++turn) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int value = turn * 1000;; ++value) {
        SiteTransaction change(folder.path());
        change.write("a", std::to_string(value));
        change.write("b", std::to_string(value));
        change.commit();
      }
    }
    ::usleep(static_cast<unsigned>(500 * turn));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    recover_site(folder.path());
    ASSERT_EQ(file_content(folder.path() / "a"), file_content(folder.path() / "b")) << "turn " << turn;
  }
}

}  // namespace
}  // namespace madori::mapping
