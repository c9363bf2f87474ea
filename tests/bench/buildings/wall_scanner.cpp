#include "tests/bench/buildings/wall_scanner.hpp"

#include "core/angle.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"

namespace madori::bench {
namespace {

constexpr Duration kTurn = std::chrono::milliseconds(20);
constexpr std::uint64_t kEveryTurn = 5;
constexpr double kRangeM = 30.0;
constexpr std::uint64_t kStream = 0x2D;

mapping::SensorRecord front() {
  mapping::SensorRecord record;
  record.name = "front";
  record.type = "lms1xx";
  record.x_m = 0.7;
  record.z_m = 0.25;
  return record;
}

simulation::PlaneScannerOptions mechanics() {
  simulation::PlaneScannerOptions options;
  options.period = kTurn;
  options.echo = {.noise_m = 0.015F, .dropout = 0.001, .range_max_m = static_cast<float>(kRangeM)};
  options.stream = kStream;
  return options;
}

}  // namespace

WallScanner::WallScanner(std::uint64_t seed) : mounting_(front()), scanner_(mounting_, mechanics(), seed) {}

void WallScanner::moved(Stamp at, const Transform2<simulation::Building, Base>& pose) {
  if (!epoch_) epoch_ = at;
  now_ = at;
  track_.add(at - *epoch_, pose);
}

std::vector<WallScanner::Scan> WallScanner::take(const simulation::World& world,
                                                 const std::vector<simulation::Body>& bodies) {
  std::vector<Scan> scans;
  while (epoch_ && *epoch_ + scanner_.next_complete() <= now_) {
    const bool wanted = scanner_.scans() % kEveryTurn == 0;
    const Stamp middle = *epoch_ + scanner_.next_start() + kTurn * 3 / 8;
    const auto& echoes = scanner_.measure({world, track_, bodies});
    if (!wanted) continue;
    LaserScan scan;
    scan.stamp = middle;
    scan.angle_min_rad = to_rad(-135.0);
    scan.angle_step_rad = to_rad(0.5);
    scan.range_max_m = kRangeM;
    for (const auto& echo : echoes) scan.ranges_m.push_back(echo.range_m);
    scans.push_back({middle, localization::extract_walls(scan, {mounting_.x_m, mounting_.y_m, 0.0})});
  }
  return scans;
}

}  // namespace madori::bench
