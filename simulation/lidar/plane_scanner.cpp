#include "simulation/lidar/plane_scanner.hpp"

#include <cmath>

#include "core/angle.hpp"

namespace madori::simulation {

const std::vector<Echo>& PlaneScanner::measure(const View& view) {
  constexpr std::size_t kBeamsOfOnePose = 8;
  const std::size_t beams = this->beams();
  beams_.reset(beams);
  SensorPose from;
  for (std::size_t i = 0; i < beams; ++i) {
    if (i % kBeamsOfOnePose == 0) {
      const Duration time =
          next_start() + options_.period * static_cast<std::int64_t>(i) / (360 * options_.beams_a_degree);
      from = sensor_pose(view.world, view.track.at(time), mounting_);
    }
    const double angle = to_rad(-135.0 + static_cast<double>(i) / options_.beams_a_degree);
    beams_.set(i, from, std::cos(angle), std::sin(angle), 0.0);
  }
  beams_.cast(view.world.rays(), view.bodies, options_.echo.range_max_m);
  Random random(seed_, options_.stream, scan_);
  echoes_.resize(beams);
  for (std::size_t i = 0; i < beams; ++i)
    echoes_[i] = echoes_of(beams_.hit(i), options_.echo, random.next()).strongest;
  ++scan_;
  return echoes_;
}

}  // namespace madori::simulation
