#pragma once

#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/bench/movers/listening_pose.hpp"
#include "tests/bench/movers/mover_score.hpp"
#include "tests/bench/movers/nearest_neighbour.hpp"
#include "tests/bench/movers/roaming_traffic.hpp"
#include "tests/bench/movers/truth_history.hpp"
#include "tests/support/lock_step_run.hpp"

namespace madori::bench {

struct DriveOptions {
  std::filesystem::path site;
  std::string scenario = "scenario.yaml";  ///< in the site's folder
  unsigned seed = 1;
  double minutes = 10.0;
  std::vector<double> thresholds_mps{0.5};  ///< of the baseline: faster clusters move
  NeighbourOptions neighbour;
};

/// What a drive has to say of the two.
struct DriveScores {
  MoverScore tracker;
  std::vector<MoverScore> baseline;  ///< by threshold
  long looks = 0;                    ///< scans at which they were compared, of all lidars
  double driven_m = 0.0;
  int orders = 0;  ///< done
  int helps = 0;   ///< of the operator: confirmed, looked, or told the place
};

/// A vehicle that drives from station to station among roaming traffic, with the product's whole cycle; each
/// time that one of its lidars looks for who moves, what the obstacle check believes, and the baseline, are
/// held against the truth of that moment. Lidars are judged each by itself, as the cycle has them.
class MoverDrive {
 public:
  /// Throws Error where the site cannot be driven.
  explicit MoverDrive(const DriveOptions& options);
  MoverDrive(const MoverDrive&) = delete;
  MoverDrive& operator=(const MoverDrive&) = delete;

  [[nodiscard]] DriveScores drive();

 private:
  struct Judged {
    NearestNeighbour neighbour;
    MoverScore tracker;
    std::vector<MoverScore> baseline;
    Stamp looked{};
  };
  void look_on(const app::CycleState& state);
  void judge(const HeardSweep& sweep, const planning::MovingObjects& objects, Judged& judged);
  void operate();
  [[nodiscard]] DriveScores scores();

  DriveOptions options_;
  app::SiteForDriving site_;
  std::mt19937 random_;
  std::vector<HeardSweep> heard_;  ///< in the step at hand
  std::unique_ptr<test::LockStepRun> run_;
  std::unique_ptr<RoamingTraffic> traffic_;
  std::unique_ptr<TruthHistory> truth_;
  std::vector<Judged> lidars_;
  std::string stands_because_;
  Stamp stands_since_{};
  long looks_ = 0;
  int orders_ = 0, helps_ = 0;
};

}  // namespace madori::bench
