#pragma once

#include <string>

#include "simulation/random.hpp"
#include "tests/bench/buildings/drive_figures.hpp"
#include "tests/support/lock_step_run.hpp"

namespace madori::bench {

/// The person beside the vehicle: presses Resume, taps once on the drawing where the vehicle cannot find
/// itself, confirms what asks for it, pulls the vehicle back from what it touched. Walls stay where they are.
class BuildingOperator {
 public:
  BuildingOperator(test::LockStepRun& run, DriveFigures& figures, simulation::Random random)
      : run_(run), figures_(figures), random_(random), since_(run.factory->now()) {}

  /// After every step.
  void look();
  /// A vehicle that has not known its place for minutes after the tap is given up.
  [[nodiscard]] bool gives_up() const;

 private:
  [[nodiscard]] double stood_s() const { return to_seconds(run_.factory->now() - since_); }
  [[nodiscard]] bool is_free_there(const Point2<Map>& place) const;
  void say(app::OperatorWord word);
  void help();
  void tap();
  void pull_back();
  void keep_trail();

  test::LockStepRun& run_;
  DriveFigures& figures_;
  simulation::Random random_;
  std::string stands_because_;
  Stamp since_;
  std::deque<Transform2<Map, Base>> trail_;  ///< true poses of the last metre, every 5 cm
};

}  // namespace madori::bench
