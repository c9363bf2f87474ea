#include "simulation/lidar/plane_scanner.hpp"

#include <cmath>

#include "core/angle.hpp"

namespace madori::simulation {

double PlaneScanner::angle_rad(std::size_t beam) const {
  return to_rad(-135.0 + static_cast<double>(beam) / options_.beams_a_degree);
}

const std::vector<Echo>& PlaneScanner::measure(const View& view) {
  constexpr std::size_t kBeamsOfOnePose = 8;
  const std::size_t beams = this->beams();
  beams_.reset(beams, options_.spot);
  SensorPose from;
  for (std::size_t i = 0; i < beams; ++i) {
    if (i % kBeamsOfOnePose == 0) {
      const Duration time =
          next_start() + options_.period * static_cast<std::int64_t>(i) / (360 * options_.beams_a_degree);
      from = sensor_pose(view.world, view.track.at(time), mounting_, options_.lean);
    }
    const double angle = angle_rad(i);
    beams_.set(i, from, std::cos(angle), std::sin(angle), 0.0);
  }
  beams_.cast(view.world.rays(), view.bodies, options_.echo.range_max_m);
  Random random(seed_, options_.stream, scan_);
  echoes_.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const auto rays = beams_.spot(i);
    const float share = rays.size() > 1 ? static_cast<float>(random.uniform()) : 0.0F;
    const SpotHits hits = meet(rays, options_.spot, share);
    echoes_[i] =
        echoes_of(hits, options_.echo, options_.bias, static_cast<float>(angle_rad(i)), random).first;
  }
  ++scan_;
  return echoes_;
}

}  // namespace madori::simulation
