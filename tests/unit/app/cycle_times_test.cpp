#include "app/runner/cycle_times.hpp"

#include <gtest/gtest.h>

namespace madori::app {
namespace {

using std::chrono::microseconds;

TEST(CycleTimes, PrometheusReadsEveryStepOnceAndCountsUpwards) {
  CycleTimes times(false);
  const CycleTimes::Clock::time_point due{};
  for (const int step_us : {100, 500, 501, 19'999, 20'000, 3'000'000})
    times.add(due, due + microseconds(40), due + microseconds(40 + step_us));
  const std::string text = times.prometheus();
  EXPECT_EQ(times.size(), 0U);
  for (const char* line :
       {"madori_cycle_step_seconds_bucket{le=\"0.0005\"} 2\n",
        "madori_cycle_step_seconds_bucket{le=\"0.001\"} 3\n",
        "madori_cycle_step_seconds_bucket{le=\"0.02\"} 5\n",
        "madori_cycle_step_seconds_bucket{le=\"0.5\"} 5\n",
        "madori_cycle_step_seconds_bucket{le=\"+Inf\"} 6\n", "madori_cycle_step_seconds_count 6\n",
        "madori_cycle_late_seconds_bucket{le=\"0.0005\"} 6\n",
        "# TYPE madori_cycle_late_seconds histogram\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

}  // namespace
}  // namespace madori::app
