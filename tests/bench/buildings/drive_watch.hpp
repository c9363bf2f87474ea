#pragma once

#include <fstream>

#include "app/cycle/cycle.hpp"
#include "simulation/factory.hpp"
#include "tests/bench/buildings/drive_figures.hpp"

namespace madori::bench {

/// Sees every step of the cycle beside what is true, and keeps the figures.
class DriveWatch {
 public:
  /// `trace` gets a line five times a second and one for every event; empty: none.
  DriveWatch(const simulation::Factory& factory, DriveFigures& figures, const std::filesystem::path& trace);

  void observe(const app::CycleOutput& output, const app::CycleState& state);
  /// From now on figures count as of a drive through a building that it has seen.
  void lap_is_over() { after_lap_ = true; }
  [[nodiscard]] double time_s() const { return to_seconds(factory_.now() - begun_); }

 private:
  void count_time(const app::CycleState& state);
  void sample_pose(const app::CycleState& state);
  void look_for_contact();
  void write_trace(const app::CycleOutput& output, const app::CycleState& state);

  const simulation::Factory& factory_;
  DriveFigures& figures_;
  std::ofstream trace_;
  Stamp begun_;
  bool after_lap_ = false;
  double driven_m_ = 0.0;
  std::size_t collisions_ = 0;
  int step_ = 0;
};

}  // namespace madori::bench
