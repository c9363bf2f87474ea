#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "app/mapping_run.hpp"
#include "app/trajectory_file.hpp"
#include "tests/support/cut_log.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/rigid_fit.hpp"

namespace madori::test {

using Way = std::vector<app::StampedPose>;

/// A planar lidar's log through a mapper: the poses as known at the end, at every record that lies in the
/// map. `run` is all that came of it.
inline Way mapped_way(sensors::LogReader& log, localization::Mapper& mapper, app::MappingRun& run) {
  run = app::run_mapper(log, planar_lidar({0.0, 0.0, 0.3, 0.0}), mapper);
  Way way;
  for (const auto& pose : run.at_last) way.push_back({pose.stamp, pose.map_from_base});
  return way;
}

/// The same of a cut log, at the stamps and in the order of the log before it was cut.
inline Way mapped_way(CutLog& log, localization::Mapper& mapper, app::MappingRun& run) {
  Way way = mapped_way(static_cast<sensors::LogReader&>(log), mapper, run);
  for (app::StampedPose& pose : way) pose.stamp = log.recorded(pose.stamp);
  std::stable_sort(way.begin(), way.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return way;
}

/// Laid rigidly on the reference by the positions at the reference's stamps. The way is in their order.
inline void lay_on(Way& way, const Way& reference) {
  constexpr Duration kSame = std::chrono::milliseconds(20);
  std::vector<std::pair<Point2<Map>, Point2<Map>>> pairs;
  for (const app::StampedPose& r : reference) {
    const auto at = std::lower_bound(way.begin(), way.end(), r.stamp - kSame,
                                     [](const app::StampedPose& p, Stamp s) { return p.stamp < s; });
    if (at != way.end() && at->stamp <= r.stamp + kSame)
      pairs.emplace_back(at->map_from_base.translation(), r.map_from_base.translation());
  }
  const auto by = fit_rigidly(pairs);
  for (app::StampedPose& pose : way) pose.map_from_base = by * pose.map_from_base;
}

}  // namespace madori::test
