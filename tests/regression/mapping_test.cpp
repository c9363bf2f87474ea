// What `madori map` makes of recorded drives, at full rate and with scans left out.
#include <gtest/gtest.h>

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "app/mapping_run.hpp"
#include "app/trajectory_score.hpp"
#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/rbpf_mapper.hpp"
#include "tests/support/mapped_way.hpp"

namespace madori::app {
namespace {

const std::filesystem::path kLogs = std::filesystem::path(MADORI_SHARED_DATA) / "lidar2d";

std::vector<sensors::LogRecord> log_records(const std::string& log, int every) {
  return test::records_of(kLogs / log / (log + ".log"), every);
}

/// Records as they are.
class Records final : public sensors::LogReader {
 public:
  explicit Records(std::vector<sensors::LogRecord> records) : records_(std::move(records)) {}
  std::optional<sensors::LogRecord> next() override {
    if (next_ == records_.size()) return std::nullopt;
    return records_[next_++];
  }

 private:
  std::vector<sensors::LogRecord> records_;
  std::size_t next_ = 0;
};

std::vector<StampedPose> final_way(const std::string& log, int every, localization::Mapper& mapper) {
  Records reader(log_records(log, every));
  MappingRun run;
  return test::mapped_way(reader, mapper, run);
}

/// A log, which scans of it, and the most that the mean of its relations may be off.
struct Drive {
  const char* log;
  int every;
  double most_m;
};
void PrintTo(const Drive& drive, std::ostream* out) {
  *out << drive.log << " every " << drive.every;
}

class MappedLog : public testing::TestWithParam<Drive> {};

TEST_P(MappedLog, KeepsTheRelations) {
  const auto& [log, every, most_m] = GetParam();
  const auto relations = kLogs / log / (std::string(log) + ".relations");
  if (!std::filesystem::exists(relations)) GTEST_SKIP() << "no relations at " << relations;
  localization::GraphMapper mapper;
  const auto way = final_way(log, every, mapper);
  const nlohmann::json score = score_against_relations(way, load_relations(relations));
  RecordProperty("translation_m", std::to_string(score["translation_m"]["mean"].get<double>()));
  EXPECT_LT(score["translation_m"]["mean"].get<double>(), most_m);
}

// Measured: 0.0398, 0.0502, 0.0650, 0.0727 m; GMapping's poses score 0.050 and 0.079 m at full rate.
INSTANTIATE_TEST_SUITE_P(Freiburg, MappedLog,
                         testing::Values(Drive{"fr079", 1, 0.0405}, Drive{"fr079", 5, 0.055},
                                         Drive{"intel", 1, 0.067}, Drive{"intel", 2, 0.08}));

// Measured with three seeds: 0.076 m; published for a Rao-Blackwellized mapper on this log 0.070 m. The log's
// clocks drop a turn once: where the wheels' word was taken for it, the relations were 1.51 m off.
TEST(MappedByParticles, IntelKeepsTheRelations) {
  const auto relations = kLogs / "intel" / "intel.relations";
  if (!std::filesystem::exists(relations)) GTEST_SKIP() << "no relations at " << relations;
  localization::RbpfMapper mapper;
  const auto way = final_way("intel", 1, mapper);
  const nlohmann::json score = score_against_relations(way, load_relations(relations));
  EXPECT_LT(score["translation_m"]["mean"].get<double>(), 0.085);
}

// Measured: mean 0.108 m, largest 0.32 m; 0.21 m before loops were sought over the whole memory.
TEST(MappedAces, StandsWithinDecimetresOfTheReference) {
  const auto reference = kLogs / "aces" / "reference.tum";
  if (!std::filesystem::exists(reference)) GTEST_SKIP() << "no log at " << reference;
  const std::vector<StampedPose> truth = load_tum(reference);
  localization::GraphMapper mapper;
  std::vector<StampedPose> way = final_way("aces", 1, mapper);
  test::lay_on(way, truth);
  EXPECT_LT(score_against_truth(way, truth)["position_m"]["mean"].get<double>(), 0.13);
}

double relations_off_m(const std::vector<StampedPose>& way) {
  const auto relations = load_relations(kLogs / "intel" / "intel.relations");
  return score_against_relations(way, relations)["translation_m"]["mean"].get<double>();
}

struct CutAndMapped {
  MappingRun run;
  std::vector<StampedPose> way;
};

CutAndMapped carried_ten_times(const char* name, unsigned order, int every = 1) {
  CutAndMapped mapped;
  test::CutLog log(log_records(name, every), 10, order);
  localization::GraphMapper mapper;
  mapped.way = test::mapped_way(log, mapper, mapped.run);
  return mapped;
}

// Measured: 0.0666 m (the map of the whole log at the same moments 0.0661 m), 862 of 910 scans in the map.
// The order of the pieces is one that thresholds were chosen on.
TEST(CarriedAway, TenTimesOnIntelIsFoundAgain) {
  if (!std::filesystem::exists(kLogs / "intel" / "intel.relations")) GTEST_SKIP() << "no log in " << kLogs;
  const CutAndMapped mapped = carried_ten_times("intel", 1);
  EXPECT_GE(mapped.run.map.carried.size(), 10U);
  EXPECT_LT(mapped.run.map.lost_scans, 100);
  EXPECT_LT(relations_off_m(mapped.way), 0.0661 * 1.1);
}

/// The log cut ten times, in each of these orders: never joined wrongly.
void expect_not_joined_wrongly(std::initializer_list<unsigned> orders, int every, std::size_t least_scans) {
  const std::vector<StampedPose> truth = load_tum(kLogs / "aces" / "reference.tum");
  for (const unsigned order : orders) {
    CutAndMapped mapped = carried_ten_times("aces", order, every);
    test::lay_on(mapped.way, truth);
    EXPECT_GT(mapped.run.map.scans.size(), least_scans);
    EXPECT_LT(score_against_truth(mapped.way, truth)["position_m"]["max"].get<double>(), 1.0) << order;
  }
}

// A building that is its own image, turned by half a turn. Measured: 0.066 m in the mean, 0.25 m at most;
// with ties of four metres, whatever the building, 13.8 m off in the mean. An order that the factor was
// chosen on; bench_carried_away cuts in others.
TEST(CarriedAway, TenTimesOnAcesIsNotJoinedWrongly) {
  if (!std::filesystem::exists(kLogs / "aces" / "reference.tum")) GTEST_SKIP() << "no log in " << kLogs;
  expect_not_joined_wrongly({2U}, 1, 40U);
}

// A scan in six seconds. Measured: 0.18 and 0.19 m at most; 40 and 19 m where what may contradict
// did not depend on how much of a scan lies on anything, and where poses were told between a carry's two
// scans.
TEST(CarriedAway, TenTimesWithEverySecondScanOfAcesIsNotJoinedWrongly) {
  if (!std::filesystem::exists(kLogs / "aces" / "reference.tum")) GTEST_SKIP() << "no log in " << kLogs;
  expect_not_joined_wrongly({1U, 2U}, 2, 25U);
}

// Nobody carried the vehicle: what little two scans have in common says so. With every second scan of Intel
// 449 of 455 are in the map (447 before joints were laid by the wheels' word), of ACES all 440.
TEST(CarriedAway, AWholeDriveIsOnePiece) {
  if (!std::filesystem::exists(kLogs / "aces" / "aces.log")) GTEST_SKIP() << "no log in " << kLogs;
  localization::GraphMapper aces, intel;
  MappingRun run;
  Records all(log_records("aces", 1)), second(log_records("intel", 2));
  (void)test::mapped_way(all, aces, run);
  EXPECT_EQ(run.map.lost_scans, 0);
  EXPECT_TRUE(run.map.carried.empty());
  (void)test::mapped_way(second, intel, run);
  EXPECT_LT(run.map.lost_scans, 10);
}

}  // namespace
}  // namespace madori::app
