// What a mapper was given, written and read again.
#include "app/mapping_drive/drive_journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <stop_token>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

struct Read {
  std::vector<OdometryReading> odometry;
  std::vector<DriveScan> scans;
  std::uintmax_t whole = 0;
};

Read read(const std::filesystem::path& file) {
  Read all;
  all.whole = read_drive(file, {.on_odometry = [&](const auto& r) { all.odometry.push_back(r); },
                                .on_scan = [&](const auto& s) { all.scans.push_back(s); }});
  return all;
}

class DriveJournalTest : public testing::Test {
 protected:
  void write(std::uintmax_t whole, int from, int to) const {
    DriveJournal journal(file_, whole);
    for (int i = from; i < to; ++i) {
      journal.add(OdometryReading{stamp_from_seconds(i), {0.1 * i, 0.0, 0.01 * i}});
      journal.add(DriveScan{stamp_from_seconds(i), {0.3, 0.0}, {{1.5, 2.25}, {-3.0, 0.5 * i}}});
    }
    journal.sync();
    EXPECT_EQ(journal.problem(), "");
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "drive.bin";
};

TEST_F(DriveJournalTest, GivesBackWhatItWasGiven) {
  write(0, 0, 5);
  const Read all = read(file_);
  ASSERT_EQ(all.odometry.size(), 5U);
  ASSERT_EQ(all.scans.size(), 5U);
  EXPECT_EQ(all.whole, std::filesystem::file_size(file_));
  EXPECT_EQ(all.odometry[3].odom_from_base.x_m(), 0.1 * 3);
  EXPECT_EQ(all.scans[4].stamp, stamp_from_seconds(4));
  EXPECT_EQ(all.scans[4].sensor.x_m, 0.3);
  EXPECT_EQ(all.scans[4].points[1], (Point2<Base>{-3.0, 2.0}));
}

TEST_F(DriveJournalTest, IsReadNoFartherThanWanted) {
  write(0, 0, 5);
  std::stop_source stop;
  int scans = 0;
  const auto whole = read_drive(file_, {.on_odometry = [](const auto&) {},
                                        .on_scan =
                                            [&](const auto&) {
                                              if (++scans == 2) stop.request_stop();
                                            },
                                        .stop = stop.get_token()});
  EXPECT_EQ(scans, 2);
  EXPECT_LT(whole, std::filesystem::file_size(file_));
}

TEST_F(DriveJournalTest, GoesOnBehindWhatWasCutOff) {
  write(0, 0, 5);
  for (const std::uintmax_t cut : {1U, 9U, 30U}) {
    std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - cut);
    const Read before = read(file_);
    EXPECT_LT(before.scans.size(), 5U);
    write(before.whole, 4, 5);
    const Read after = read(file_);
    EXPECT_EQ(after.scans.size(), before.scans.size() + 1);
    EXPECT_EQ(after.scans.back().stamp, stamp_from_seconds(4));
  }
}

TEST_F(DriveJournalTest, EndsBeforeADamagedRecord) {
  write(0, 0, 5);
  std::fstream bytes(file_, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file_) / 2));
  bytes.put('!');
  bytes.close();
  const Read some = read(file_);
  EXPECT_GT(some.scans.size(), 0U);
  EXPECT_LT(some.scans.size(), 5U);
  EXPECT_LT(some.whole, std::filesystem::file_size(file_));
}

/// A disk that is full for a while: the limit on a file's size stands for it.
TEST_F(DriveJournalTest, WhatAFullDiskDidNotTakeIsMissingAndNothingElse) {
  write(0, 0, 5);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  DriveJournal journal(file_, std::filesystem::file_size(file_));
  const auto add = [&](int i) {
    journal.add(DriveScan{stamp_from_seconds(i), {0.3, 0.0}, std::vector<Point2<Base>>(40, {1.0, 2.0})});
  };
  const rlimit full{std::filesystem::file_size(file_) + 50, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  add(5);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  (void)std::signal(SIGXFSZ, ignored);
  EXPECT_NE(journal.problem(), "");
  add(6);
  const Read all = read(file_);
  EXPECT_EQ(all.whole, std::filesystem::file_size(file_));
  ASSERT_EQ(all.scans.size(), 6U);
  EXPECT_EQ(all.scans.back().stamp, stamp_from_seconds(6));
}

TEST_F(DriveJournalTest, AnotherFileIsRefusedAndNoneIsADriveOfNothing) {
  EXPECT_EQ(read(file_).whole, 0U);
  const auto other = folder_.write("other.bin", "a file that is long enough to have a head");
  EXPECT_THROW((void)read(other), Error);
  EXPECT_THROW(DriveJournal(folder_.path() / "no" / "such", 0), Error);
}

}  // namespace
}  // namespace madori::app
