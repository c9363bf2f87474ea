#include "tests/bench/movers/plain_sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace madori::bench {
namespace {

using namespace simulation;

constexpr double kMostDirections = 24.0;

/// The bearings from the lidar that a body lies between, Lidar frame.
std::array<double, 2> bearings_of(const Body& body, const LidarPlace& lidar) {
  const auto lidar_from_building = lidar.pose.inverse();
  const Point2<Lidar> centre = lidar_from_building * body.centre;
  const double middle = std::atan2(centre.y_m, centre.x_m);
  double right = 0.0, left = 0.0;
  for (const auto& corner : outline(body)) {
    const Point2<Lidar> at = lidar_from_building * corner;
    const double off = wrap_angle(std::atan2(at.y_m, at.x_m) - middle);
    right = std::min(right, off);
    left = std::max(left, off);
  }
  return {middle + right, middle + left};
}

bool looks_at(const LidarModel& model, double bearing) {
  const double turned = bearing - 2.0 * kPi * std::floor((bearing - model.from_rad) / (2.0 * kPi));
  return turned <= model.to_rad;
}

/// Those of the rays that meet nothing before `range_m`, each its own.
class Rays {
 public:
  void add(const Ray& ray, float range_m) { rays_.push_back({ray, range_m}); }
  [[nodiscard]] double unhidden(const Body& body, const std::vector<Body>& all, const RayCaster& building) {
    std::erase_if(rays_, [&](const auto& r) {
      return std::any_of(all.begin(), all.end(), [&](const Body& other) {
        return other.name != body.name && range_to(other, r.ray) < r.range_m;
      });
    });
    double met = 0.0;
    for (std::size_t first = 0; first < rays_.size(); first += RayPacket::kLanes)
      met += unhidden_of_packet(first, building);
    return met;
  }

 private:
  struct Towards {
    Ray ray;
    float range_m;
  };
  [[nodiscard]] double unhidden_of_packet(std::size_t first, const RayCaster& building) const {
    RayPacket packet;
    std::array<Hit, RayPacket::kLanes> hits;
    const std::size_t count = std::min(RayPacket::kLanes, rays_.size() - first);
    for (std::size_t i = 0; i < RayPacket::kLanes; ++i) {
      const Ray& ray = rays_[first + std::min(i, count - 1)].ray;
      packet.x_m[i] = static_cast<float>(ray.x_m), packet.dx[i] = static_cast<float>(ray.dx);
      packet.y_m[i] = static_cast<float>(ray.y_m), packet.dy[i] = static_cast<float>(ray.dy);
      packet.z_m[i] = static_cast<float>(ray.z_m), packet.dz[i] = static_cast<float>(ray.dz);
    }
    building.cast(packet, hits);
    double met = 0.0;
    for (std::size_t i = 0; i < count; ++i) met += hits[i].range_m > rays_[first + i].range_m ? 1.0 : 0.0;
    return met;
  }
  std::vector<Towards> rays_;
};

}  // namespace

BeamsOn beams_on(const Body& body, const std::vector<Body>& all, const RayCaster& building,
                 const LidarPlace& lidar) {
  const LidarModel& model = lidar.model;
  const auto [right, left] = bearings_of(body, lidar);
  const double step = std::max(model.step_rad, (left - right) / kMostDirections);
  const double ring_step = model.ring_step_rad > 0.0 ? model.ring_step_rad : 1.0;
  Rays rays;
  double would = 0.0;
  for (double bearing = right + 0.5 * step; bearing < left; bearing += step) {
    if (!looks_at(model, bearing)) continue;
    const double yaw = lidar.pose.yaw_rad() + bearing;
    for (double up = model.min_elevation_rad; up <= model.max_elevation_rad + 1e-6; up += ring_step) {
      const Ray ray{lidar.pose.x_m(),
                    lidar.pose.y_m(),
                    model.mounting.z_m,
                    std::cos(up) * std::cos(yaw),
                    std::cos(up) * std::sin(yaw),
                    std::sin(up)};
      const float range_m = range_to(body, ray);
      if (!(range_m < static_cast<float>(model.range_max_m))) continue;
      would += 1.0;
      rays.add(ray, range_m);
    }
  }
  const double beams_a_ray = step / model.step_rad;
  return {beams_a_ray * rays.unhidden(body, all, building), beams_a_ray * would};
}

bool is_in_plain_sight(const BeamsOn& beams) {
  constexpr double kFewest = 3.0, kShare = 0.5;
  return beams.met >= kFewest && beams.met >= kShare * beams.would;
}

}  // namespace madori::bench
