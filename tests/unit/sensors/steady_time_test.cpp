#include "sensors/steady_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sensors/open_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::sensors {
namespace {

using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

class GivenRecords final : public LogReader {
 public:
  explicit GivenRecords(std::vector<LogRecord> records) : records_(std::move(records)) {}
  std::optional<LogRecord> next() override {
    return at_ < records_.size() ? std::optional(records_[at_++]) : std::nullopt;
  }

 private:
  std::vector<LogRecord> records_;
  std::size_t at_ = 0;
};

OdometryReading wheel(double time_s) {
  return {stamp_from_seconds(time_s), {}};
}
ScanRecord sight(double time_s, const std::string& source = "FLASER") {
  ScanRecord record{source, {}, {}, {}, {}};
  record.scan.stamp = stamp_from_seconds(time_s);
  return record;
}

std::vector<double> times_of(const std::vector<LogRecord>& records,
                             std::vector<std::string>* told = nullptr) {
  SteadyTimeReader reader(std::make_unique<GivenRecords>(records), [&](const std::string& what) {
    if (told != nullptr) told->push_back(what);
  });
  std::vector<double> times;
  while (const auto record = reader.next()) times.push_back(to_seconds(stamp_of(*record)));
  return times;
}

/// A drive with wheels at 20 Hz and scans at 5 Hz, 20 ms later; from 2 s on the clock is behind by `back_s`.
std::vector<LogRecord> drive_with_clock_set(double back_s, bool scans_too = true) {
  std::vector<LogRecord> records;
  for (int i = 0; i < 80; ++i) {
    const double time_s = 100.0 + 0.05 * i, off_s = i < 40 ? 0.0 : -back_s;
    records.emplace_back(wheel(time_s + off_s));
    if (i % 4 == 0) records.emplace_back(sight(time_s + 0.02 + (scans_too ? off_s : 0.0)));
  }
  return records;
}

TEST(SteadyTime, GoesOnWhereTheClockWasSetBack) {
  const std::vector<double> right = times_of(drive_with_clock_set(0.0));
  for (const double back_s : {0.5, 5.0, 3600.0, -0.0}) {
    std::vector<std::string> told;
    EXPECT_THAT(times_of(drive_with_clock_set(back_s), &told), Pointwise(DoubleNear(1e-6), right)) << back_s;
    EXPECT_EQ(told.size(), back_s > 0.0 ? 1U : 0U);
  }
}

TEST(SteadyTime, GoesOnAsOftenAsItIsSetAndTellsOnce) {
  std::vector<LogRecord> records;
  std::vector<double> right;
  for (int i = 0; i < 60; ++i) {
    records.emplace_back(sight(100.0 + 0.1 * i - 50.0 * (i / 20)));
    right.push_back(100.0 + 0.1 * i);
  }
  std::vector<std::string> told;
  EXPECT_THAT(times_of(records, &told), Pointwise(DoubleNear(1e-6), right));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told.front(), HasSubstr("scans of FLASER was set back"));
}

TEST(SteadyTime, ThatOfOneKindAloneLeavesTheOthersTheirs) {
  EXPECT_THAT(times_of(drive_with_clock_set(5.0, false)),
              Pointwise(DoubleNear(1e-6), times_of(drive_with_clock_set(0.0))));
}

TEST(SteadyTime, StragglersPassAsTheyAre) {
  std::vector<LogRecord> records;
  for (int i = 0; i < 40; ++i) {
    records.emplace_back(wheel(10.0 + 0.1 * i));
    if (i % 2 == 0) records.emplace_back(sight(10.0 + 0.1 * i - (i % 10 == 8 ? 0.9 : 0.0)));
    if (i % 7 == 6) records.emplace_back(wheel(9.0 + 0.1 * i)), records.emplace_back(wheel(9.1 + 0.1 * i));
  }
  records.emplace_back(sight(11.0));  // and the last of all
  std::vector<double> as_they_came;
  for (const LogRecord& record : records) as_they_came.push_back(to_seconds(stamp_of(record)));
  std::vector<std::string> told;
  EXPECT_THAT(times_of(records, &told), Pointwise(DoubleNear(1e-6), as_they_came));
  EXPECT_TRUE(told.empty());
}

TEST(SteadyTime, TwoClocksThatDifferAllAlongAreNoSet) {
  std::vector<LogRecord> records;
  std::vector<double> as_they_came;
  for (int i = 0; i < 50; ++i) {
    const double time_s = 10.0 + 0.1 * i;
    as_they_came.push_back(time_s);
    records.emplace_back(wheel(time_s));
    if (i % 9 != 0) continue;
    as_they_came.push_back(time_s + 500.0);
    records.emplace_back(sight(time_s + 500.0));
  }
  EXPECT_THAT(times_of(records), Pointwise(DoubleNear(1e-6), as_they_came));
}

TEST(OpenLog, KeepsTimeGoingOn) {
  const test::TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "ODOM 0 0 0 0 0 0 " + std::to_string(5000 + i - (i < 10 ? 0 : 3600)) + " h 0\n";
  LogOptions options;
  std::string told;
  options.remark = [&](const std::string& what) { told += what; };
  const auto log = open_log(folder.write("set.log", text), options);
  for (int i = 0; i < 20; ++i) EXPECT_DOUBLE_EQ(to_seconds(stamp_of(*log->next())), 5000.0 + i);
  EXPECT_THAT(told, HasSubstr("set.log: the clock of the odometry was set back"));
}

}  // namespace
}  // namespace madori::sensors
