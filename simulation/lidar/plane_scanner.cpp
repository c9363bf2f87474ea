#include "simulation/lidar/plane_scanner.hpp"

#include <cmath>

#include "core/angle.hpp"

namespace madori::simulation {

const std::vector<Echo>& PlaneScanner::measure(const View& view) {
  constexpr std::size_t kBeamsOfOnePose = 8;
  beams_.reset(kBeams);
  SensorPose from;
  for (std::size_t i = 0; i < kBeams; ++i) {
    if (i % kBeamsOfOnePose == 0) {
      const Duration time = next_start() + options_.period * static_cast<std::int64_t>(i) / 720;
      from = sensor_pose(view.world, view.track.at(time), mounting_);
    }
    const double angle = to_rad(-135.0 + 0.5 * static_cast<double>(i));
    beams_.set(i, from, std::cos(angle), std::sin(angle), 0.0);
  }
  beams_.cast(view.world.rays(), view.bodies, options_.echo.range_max_m);
  Random random(seed_, options_.stream, scan_);
  echoes_.resize(kBeams);
  for (std::size_t i = 0; i < kBeams; ++i)
    echoes_[i] = echoes_of(beams_.hit(i), options_.echo, random.next()).strongest;
  ++scan_;
  return echoes_;
}

}  // namespace madori::simulation
