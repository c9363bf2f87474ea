// A desk that is busy reading an earlier drive while the vehicle goes on.
#include "app/mapping_drive/mapping_desk.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "mapping/site/atomic_file.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

/// Two walls of a corner, as points every 5 cm.
DriveScan corner_seen_at(double t_s, double x_m) {
  DriveScan scan{stamp_from_seconds(t_s), {0.0, 0.0}, {}};
  for (int i = 0; i < 100; ++i) {
    scan.points.push_back({-1.0 + 0.05 * i - x_m, 2.0});
    scan.points.push_back({4.0 - x_m, -3.0 + 0.05 * i});
  }
  return scan;
}

/// The earlier drive comes through a pipe, so that it is read when the test says so.
class BusyDesk : public testing::Test {
 protected:
  BusyDesk() {
    const auto earlier = folder_.path() / "earlier.bin";
    {
      DriveJournal journal(earlier, 0);
      for (int i = 0; i <= 10; ++i) {
        journal.add(OdometryReading{stamp_from_seconds(i), {0.1 * i, 0.0, 0.0}});
        journal.add(corner_seen_at(i, 0.1 * i));
      }
    }
    earlier_ = mapping::file_content(earlier);
    EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
    desk_.emplace(MappingDesk::Options{pipe_});
  }
  ~BusyDesk() override {
    desk_.reset();
    ::close(reader_);
  }
  BusyDesk(const BusyDesk&) = delete;
  BusyDesk& operator=(const BusyDesk&) = delete;
  /// The wheels from 0 on, 1 mm a reading; a scan before them.
  void give(int readings) {
    desk_->on_odometry({stamp_from_seconds(100.0), {}});
    desk_->on_scan(corner_seen_at(100.0, 1.0), {});
    for (int i = 1; i < readings; ++i)
      desk_->on_odometry({stamp_from_seconds(100.0 + 0.01 * i), {0.001 * i, 0.0, 0.0}});
  }
  void let_it_read() {
    const int pipe = ::open(pipe_.c_str(), O_WRONLY);        // waits until the desk reads
    reader_ = ::open(pipe_.c_str(), O_RDONLY | O_NONBLOCK);  // the desk shall not wait for one
    ASSERT_EQ(::write(pipe, earlier_.data(), earlier_.size()), static_cast<ssize_t>(earlier_.size()));
    ::close(pipe);
    // a pipe cannot be written behind: the desk goes on and says so
    ASSERT_TRUE(test::eventually([&] { return !desk_->progress().reading; }));
  }
  test::TemporaryFolder folder_;
  std::filesystem::path pipe_ = folder_.path() / "drive.bin";
  std::string earlier_;
  int reader_ = -1;
  std::optional<MappingDesk> desk_;
};

TEST_F(BusyDesk, JoinsTheEarlierDriveWhereTheWheelsFirstWere) {
  give(4000);  // more than wait: the first ones are dropped
  let_it_read();
  desk_->on_scan(corner_seen_at(140.0, 1.0 + 3.999), {3.999, 0.0, 0.0});
  ASSERT_TRUE(test::eventually([&] { return desk_->progress().scans == 12; }));
  const auto newest = desk_->newest();
  ASSERT_TRUE(newest);
  EXPECT_NEAR(newest->pose.map_from_base.x_m(), 1.0 + 3.999, 0.1);
}

TEST_F(BusyDesk, AScanThatIsDroppedWaitsNoMore) {
  give(4000);
  EXPECT_EQ(desk_->progress().waiting, 0U);
  EXPECT_EQ(desk_->progress().dropped, 1);
  let_it_read();
}

/// It is somebody else's to go on with: cut short, it could not.
TEST(MappingDesk, ADriveThatIsNotReadToItsEndStaysWhole) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "drive.bin";
  {
    DriveJournal journal(file, 0);
    for (int i = 0; i < 3000; ++i) {
      journal.add(OdometryReading{stamp_from_seconds(i), {0.1 * (i % 30), 0.0, 0.0}});
      journal.add(corner_seen_at(i, 0.1 * (i % 30)));
    }
  }
  const auto bytes = std::filesystem::file_size(file);
  const auto begun = std::chrono::steady_clock::now();
  {
    MappingDesk desk({file});
    ASSERT_TRUE(test::eventually([&] { return desk.progress().scans > 0; }));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(5));
  EXPECT_EQ(std::filesystem::file_size(file), bytes);
}

}  // namespace
}  // namespace madori::app
