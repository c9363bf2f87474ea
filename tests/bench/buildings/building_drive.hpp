#pragma once

#include "tests/bench/buildings/building_operator.hpp"
#include "tests/bench/buildings/building_site.hpp"
#include "tests/bench/buildings/drive_watch.hpp"

namespace madori::bench {

struct DriveOptions {
  std::string source = "localizer";
  std::string sensor = "vlp16";  ///< or scan: what it localizes with
  unsigned seed = 1;
  int laps = 2;            ///< the first one learns
  double limit_s = 300.0;  ///< of one delivery, simulated
  std::filesystem::path
      hand_made;                ///< BUILDING/walls.csv below it in place of the imported walls; empty: those
  std::filesystem::path trace;  ///< folder of one CSV a start; empty: none
};

/// One start: the program begins with no pose, and delivers to every station in turn, lap after lap.
class BuildingDrive {
 public:
  BuildingDrive(const BuildingStart& start, const DriveOptions& options);
  BuildingDrive(const BuildingDrive&) = delete;
  BuildingDrive& operator=(const BuildingDrive&) = delete;

  [[nodiscard]] DriveFigures drive();

 private:
  bool tick();
  void drive_laps();
  [[nodiscard]] std::vector<int> stations_in_turn(int last);
  bool deliver(int station, int lap);
  void note_visit(int station, int lap, double after_s);
  void note_undelivered(int station, std::int64_t order, const std::string& why);

  DriveOptions options_;
  DriveFigures figures_;
  test::TemporaryFolder folder_;
  app::SiteForDriving site_;
  simulation::Random random_;
  std::unique_ptr<test::LockStepRun> run_;
  std::unique_ptr<DriveWatch> watch_;
  std::unique_ptr<BuildingOperator> operator_;
  std::vector<Segment2<Map>> drawn_;
};

}  // namespace madori::bench
