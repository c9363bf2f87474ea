#include "simulation/lidar/view.hpp"

#include <algorithm>
#include <cmath>

namespace madori::simulation {
namespace {

constexpr Duration kKept = std::chrono::milliseconds(200);
constexpr double kBodySlackM =
    0.1;  ///< the rays of a batch leave from where the vehicle is at their own time

Ray ray_of(const RayPacket& p, std::size_t lane) {
  return {p.x_m[lane], p.y_m[lane], p.z_m[lane], p.dx[lane], p.dy[lane], p.dz[lane]};
}

/// The directions of a batch as seen from above: those within `half_rad` of (x, y).
struct Fan {
  double x = 1.0, y = 0.0, half_rad = kPi;

  /// Whether a ray from (0, 0) may come within `reach` of (bx, by).
  [[nodiscard]] bool may_meet(double bx, double by, double reach) const {
    const double away = std::hypot(bx, by);
    if (away <= reach) return true;
    const double beside_rad = std::abs(std::atan2(x * by - y * bx, x * bx + y * by));
    return beside_rad <= half_rad + std::asin(reach / away);
  }
};

Fan fan_of(const std::vector<RayPacket>& packets, std::size_t count) {
  double x = 0.0, y = 0.0, least_cosine = 1.0;
  const auto each = [&](auto&& visit) {
    for (std::size_t i = 0; i < count; ++i) {
      const RayPacket& p = packets[i / RayPacket::kLanes];
      visit(static_cast<double>(p.dx[i % RayPacket::kLanes]),
            static_cast<double>(p.dy[i % RayPacket::kLanes]));
    }
  };
  each([&](double dx, double dy) { x += dx, y += dy; });
  const double length = std::hypot(x, y);
  if (length < 1e-3) return {};
  x /= length;
  y /= length;
  each([&](double dx, double dy) {
    least_cosine = std::min(least_cosine, (dx * x + dy * y) / std::max(std::sqrt(dx * dx + dy * dy), 1e-9));
  });
  return {x, y, std::acos(std::clamp(least_cosine, -1.0, 1.0)) + 1e-3};
}

}  // namespace

void PoseTrack::add(Duration time, const Transform2<Building, Base>& pose) {
  poses_.push_back({time, pose});
  while (poses_.size() > 2 && poses_[1].time < time - kKept) poses_.pop_front();
}

Transform2<Building, Base> PoseTrack::at(Duration time) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time,
                                      [](const Entry& e, Duration t) { return e.time < t; });
  if (after == poses_.end()) return poses_.back().pose;
  if (after == poses_.begin() || after->time == time) return after->pose;
  const Entry &a = *(after - 1), &b = *after;
  const double t =
      static_cast<double>((time - a.time).count()) / static_cast<double>((b.time - a.time).count());
  return {a.pose.x_m() + t * (b.pose.x_m() - a.pose.x_m()), a.pose.y_m() + t * (b.pose.y_m() - a.pose.y_m()),
          a.pose.yaw_rad() + t * wrap_angle(b.pose.yaw_rad() - a.pose.yaw_rad())};
}

SensorPose sensor_pose(const World& world, const Transform2<Building, Base>& pose,
                       const mapping::SensorRecord& mounting, const Lean& lean) {
  const FloorAt floor = world.floor_at(pose.translation());
  // Base axes on the slope: x along the heading, z the floor's normal, y the rest.
  const double rise = floor.slope_x * pose.cos_yaw() + floor.slope_y * pose.sin_yaw();
  const double forward = std::sqrt(1.0 + rise * rise);
  const std::array<double, 3> x{pose.cos_yaw() / forward, pose.sin_yaw() / forward, rise / forward};
  const double up = std::sqrt(1.0 + floor.slope_x * floor.slope_x + floor.slope_y * floor.slope_y);
  const std::array<double, 3> z{-floor.slope_x / up, -floor.slope_y / up, 1.0 / up};
  const std::array<double, 3> y{z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2],
                                z[0] * x[1] - z[1] * x[0]};
  const double c = std::cos(to_rad(mounting.yaw_deg)), s = std::sin(to_rad(mounting.yaw_deg));
  const double cp = std::cos(to_rad(lean.pitch_deg)), sp = std::sin(to_rad(lean.pitch_deg));
  const double cr = std::cos(to_rad(lean.roll_deg)), sr = std::sin(to_rad(lean.roll_deg));
  SensorPose result;
  const std::array<double, 3> base{pose.x_m(), pose.y_m(), floor.z_m};
  for (std::size_t i = 0; i < 3; ++i) {
    result.origin_m[i] = base[i] + x[i] * mounting.x_m + y[i] * mounting.y_m + z[i] * mounting.z_m;
    // Yaw, then pitch about the new y, then roll about the new x.
    const double ahead = x[i] * c + y[i] * s, left = y[i] * c - x[i] * s;
    const double up_pitched = z[i] * cp + ahead * sp;
    result.rotation[3 * i] = ahead * cp - z[i] * sp;
    result.rotation[3 * i + 1] = left * cr + up_pitched * sr;
    result.rotation[3 * i + 2] = up_pitched * cr - left * sr;
  }
  return result;
}

void BeamBatch::reset(std::size_t count, const BeamSpot& spot) {
  spot_ = spot;
  beams_ = count;
  count_ = count * spot.rays().size();
  const std::size_t packets = (count_ + RayPacket::kLanes - 1) / RayPacket::kLanes;
  packets_.resize(packets);
  hits_.assign(packets * RayPacket::kLanes, Hit{});
  if (count_ % RayPacket::kLanes == 0 || packets == 0) return;
  RayPacket& last = packets_.back();
  for (std::size_t lane = count_ % RayPacket::kLanes; lane < RayPacket::kLanes; ++lane)
    last.dx[lane] = last.dy[lane] = 0.0F, last.dz[lane] = 1.0F;
}

void BeamBatch::set(std::size_t i, const SensorPose& from, double dx, double dy, double dz) {
  const auto turned = [&r = from.rotation](double x, double y, double z) -> Vector {
    return {r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z};
  };
  const Vector direction = turned(dx, dy, dz);
  if (spot_.rays().size() == 1) return set_ray(i, from.origin_m, direction);
  const double per_flat = 1.0 / std::sqrt(dx * dx + dy * dy), lx = -dy * per_flat, ly = dx * per_flat;
  const Vector left = turned(lx, ly, 0.0), up = turned(-dz * ly, dz * lx, dx * ly - dy * lx);
  const double radius_m = spot_.beam_m() / 2.0, spread = spot_.spread_rad() / 2.0;
  for (std::size_t ray = 0; ray < spot_.rays().size(); ++ray) {
    const auto& offset = spot_.rays()[ray];
    Vector origin = from.origin_m, aim = direction;
    for (std::size_t k = 0; k < 3; ++k) {
      const double beside = offset.left * left[k] + offset.up * up[k];
      origin[k] += beside * radius_m;
      aim[k] += beside * spread;
    }
    set_ray(ray * beams_ + i, origin, aim);
  }
}

void BeamBatch::set_ray(std::size_t ray, const Vector& origin, const Vector& direction) {
  RayPacket& p = packets_[ray / RayPacket::kLanes];
  const std::size_t lane = ray % RayPacket::kLanes;
  p.x_m[lane] = static_cast<float>(origin[0]);
  p.y_m[lane] = static_cast<float>(origin[1]);
  p.z_m[lane] = static_cast<float>(origin[2]);
  p.dx[lane] = static_cast<float>(direction[0]);
  p.dy[lane] = static_cast<float>(direction[1]);
  p.dz[lane] = static_cast<float>(direction[2]);
}

std::span<const Hit> BeamBatch::spot(std::size_t i) const {
  of_spot_.resize(spot_.rays().size());
  for (std::size_t ray = 0; ray < of_spot_.size(); ++ray) of_spot_[ray] = hits_[ray * beams_ + i];
  return of_spot_;
}

void BeamBatch::cast(const RayCaster& rays, const std::vector<Body>& bodies, float range_max_m) {
  for (std::size_t i = 0; i < packets_.size(); ++i)
    rays.cast(packets_[i],
              std::span<Hit, RayPacket::kLanes>(&hits_[i * RayPacket::kLanes], RayPacket::kLanes));
  if (bodies.empty() || packets_.empty()) return;
  const Fan fan = fan_of(packets_, count_);
  for (const Body& body : bodies) {
    const double bx = body.centre.x_m - packets_.front().x_m[0];
    const double by = body.centre.y_m - packets_.front().y_m[0];
    if (fan.may_meet(bx, by, body.reach_m() + kBodySlackM)) cast_body(body, range_max_m);
  }
}

void BeamBatch::cast_body(const Body& body, float range_max_m) {
  const double reach = body.reach_m() + 0.05;
  for (std::size_t p = 0; p < packets_.size(); ++p) {
    const RayPacket& packet = packets_[p];
    const double bx = body.centre.x_m - packet.x_m[0], by = body.centre.y_m - packet.y_m[0];
    if (bx * bx + by * by > (range_max_m + reach) * (range_max_m + reach)) return;
    for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
      const std::size_t i = p * RayPacket::kLanes + lane;
      if (i >= count_) return;
      // Floor distance of the ray's line from the body's middle, times the ray's floor length.
      const double dx = packet.dx[lane], dy = packet.dy[lane];
      const double beside = bx * dy - by * dx, length_squared = dx * dx + dy * dy;
      if (beside * beside > reach * reach * length_squared) continue;
      const float range = range_to(body, ray_of(packet, lane));
      if (range >= hits_[i].range_m) continue;
      hits_[i].range_m = range;
      hits_[i].material = body.material;
      hits_[i].incidence_cos = 1.0F;
      if (hits_[i].glass_m > range) hits_[i].glass_m = Hit::kNothing;
    }
  }
}

}  // namespace madori::simulation
