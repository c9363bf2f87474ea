#pragma once

#include <benchmark/benchmark.h>

#include <vector>

#include "localization/registration/segment_icp.hpp"
#include "tests/bench/localization_scene.hpp"

namespace madori::bench {

inline const mapping::Walls& hall() {
  static const mapping::Walls walls = hall_100_by_60();
  return walls;
}
inline const std::vector<Task>& tasks() {
  static const std::vector<Task> forty = forty_tasks(hall());
  return forty;
}

/// Times `answer(task)` over the forty tasks and says how right it was.
template <class Answer>
void forty_times(benchmark::State& state, Answer&& answer) {
  std::vector<Pose> answers(tasks().size());
  for (auto _ : state)
    for (std::size_t i = 0; i < tasks().size(); ++i) answers[i] = answer(tasks()[i]);
  const Accuracy a = accuracy(tasks(), answers);
  state.counters["per_scan"] =
      benchmark::Counter(static_cast<double>(tasks().size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["right_of_40"] = a.right;
  state.counters["median_mm"] = 1e3 * a.median_m;
}

/// Ours, the yardstick of every peer.
inline void point_to_segment_icp(benchmark::State& state) {
  const localization::SegmentGrid grid(hall());
  forty_times(state,
              [&](const Task& t) { return localization::segment_icp(t.scan, grid, t.start).map_from_base; });
}

}  // namespace madori::bench
