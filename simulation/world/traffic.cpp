#include "simulation/world/traffic.hpp"

#include <algorithm>
#include <cmath>

namespace madori::simulation {
namespace {

constexpr double kLeafHalfThicknessM = 0.04;
constexpr double kFullyOpen = 0.999;

/// Shape of a kind. The two test bodies are those of EN 1525 / ISO 3691-4: 70 mm x 400 mm upright,
/// 200 mm x 600 mm lying across the path.
Body shape_of(MoverKind kind) {
  Body b;
  switch (kind) {
    case MoverKind::Person:
      b.half_length_m = b.half_width_m = 0.23, b.z = {0.0, 1.75}, b.round = true;
      break;
    case MoverKind::Forklift:
      b.half_length_m = 1.25, b.half_width_m = 0.6, b.z = {0.0, 2.1}, b.material = Material::Metal;
      break;
    case MoverKind::Cart:
      b.half_length_m = 0.5, b.half_width_m = 0.35, b.z = {0.0, 1.1}, b.material = Material::Metal;
      break;
    case MoverKind::Pallet:
      b.half_length_m = 0.6, b.half_width_m = 0.4, b.z = {0.0, 0.9}, b.material = Material::Wood;
      break;
    case MoverKind::UprightBody:
      b.half_length_m = b.half_width_m = 0.035, b.z = {0.0, 0.4}, b.round = true;
      break;
    case MoverKind::LyingBody:
      b.half_length_m = 0.3, b.half_width_m = 0.1, b.z = {0.0, 0.2};
      break;
  }
  return b;
}

}  // namespace

Mover::Mover(const MoverSpec& spec, const PlanFrames& frames) : spec_(spec), body_(shape_of(spec.kind)) {
  body_.name = spec.name;
  for (const auto& p : spec.path) path_.push_back(frames.building(p));
  if (spec.loop && path_.size() > 2) path_.push_back(path_.front());
  for (std::size_t i = 1; i < path_.size(); ++i)
    ends_m_.push_back(length_m() + distance_m(path_[i - 1], path_[i]));
  place();
}

void Mover::place() {
  std::size_t leg = 0;
  while (leg + 1 < ends_m_.size() && way_m_ > ends_m_[leg]) ++leg;
  if (ends_m_.empty()) {
    body_.centre = path_.front();
    body_.yaw_rad = to_rad(spec_.yaw_deg);
    return;
  }
  const Point2<Building>&a = path_[leg], &b = path_[leg + 1];
  const double length = std::max(distance_m(a, b), 1e-9);
  const double t = (way_m_ - (ends_m_[leg] - length)) / length;
  body_.centre = {a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)};
  const double sign = direction_;
  body_.yaw_rad = std::atan2(sign * (b.y_m - a.y_m), sign * (b.x_m - a.x_m));
}

bool Mover::waits_for(const VehicleCircle& vehicle) const {
  if (spec_.polite_m <= 0.0) return false;
  const double dx = vehicle.centre.x_m - body_.centre.x_m, dy = vehicle.centre.y_m - body_.centre.y_m;
  const double distance = spec_.polite_m + vehicle.reach_m + body_.reach_m();
  if (dx * dx + dy * dy >= distance * distance) return false;
  return dx * std::cos(body_.yaw_rad) + dy * std::sin(body_.yaw_rad) > 0.0;
}

void Mover::advance(double now_s, double dt_s, const VehicleCircle& vehicle) {
  if (ends_m_.empty() || now_s < spec_.start_s || now_s < paused_until_s_) return;
  if (waits_for(vehicle)) {
    waited_s_ += dt_s;
    if (spec_.patience_s <= 0.0 || waited_s_ < spec_.patience_s) return;
    direction_ = -direction_;
    waited_s_ = 0.0;
    place();
    return;
  }
  waited_s_ = 0.0;
  way_m_ += direction_ * spec_.speed_mps * dt_s;
  if (way_m_ >= length_m() || way_m_ <= 0.0) {
    paused_until_s_ = now_s + spec_.pause_s;
    if (spec_.loop)
      way_m_ = direction_ > 0 ? 0.0 : length_m();
    else
      direction_ = way_m_ <= 0.0 ? 1 : -1;
    way_m_ = std::clamp(way_m_, 0.0, length_m());
  }
  place();
}

Door::Door(const DoorSpec& spec, const PlanFrames& frames)
    : spec_(spec), line_{frames.building(spec.line.a), frames.building(spec.line.b)} {}

double Door::distance_to(const Point2<Building>& p) const {
  const double ux = line_.b.x_m - line_.a.x_m, uy = line_.b.y_m - line_.a.y_m;
  const double t =
      std::clamp(((p.x_m - line_.a.x_m) * ux + (p.y_m - line_.a.y_m) * uy) / (ux * ux + uy * uy), 0.0, 1.0);
  return std::hypot(line_.a.x_m + t * ux - p.x_m, line_.a.y_m + t * uy - p.y_m);
}

void Door::advance(double now_s, double dt_s, const VehicleCircle& vehicle,
                   const std::vector<Mover>& movers) {
  bool wanted = false;
  if (spec_.trigger_m > 0.0) {
    wanted = distance_to(vehicle.centre) < spec_.trigger_m + vehicle.reach_m;
    for (const Mover& m : movers) wanted = wanted || distance_to(m.body().centre) < spec_.trigger_m;
  } else {
    wanted = std::fmod(now_s, spec_.period_s) < spec_.hold_s;
  }
  if (wanted) wanted_until_s_ = now_s + (spec_.trigger_m > 0.0 ? spec_.hold_s : 0.0);
  // A door never closes on what stands in it: the light curtain.
  const bool occupied = distance_to(vehicle.centre) < vehicle.reach_m;
  const double step = dt_s / spec_.opening_s;
  const bool opens = occupied || now_s <= wanted_until_s_;
  const double most = now_s < spec_.stuck_until_s ? spec_.stuck_at : 1.0;
  openness_ = opens ? std::min(openness_ + step, most) : std::max(openness_ - step, 0.0);
}

std::optional<Body> Door::leaf() const {
  if (openness_ > kFullyOpen) return std::nullopt;
  Body b;
  b.name = spec_.name;
  b.material = Material::Metal;
  b.half_width_m = kLeafHalfThicknessM;
  b.z = {0.0, spec_.height_m};
  Segment2<Building> shut = line_;
  if (spec_.kind == DoorKind::Lift)
    b.z.low_m = openness_ * spec_.height_m;
  else
    shut.a = {line_.a.x_m + openness_ * (line_.b.x_m - line_.a.x_m),
              line_.a.y_m + openness_ * (line_.b.y_m - line_.a.y_m)};
  b.centre = {(shut.a.x_m + shut.b.x_m) / 2.0, (shut.a.y_m + shut.b.y_m) / 2.0};
  b.half_length_m = shut.length_m() / 2.0;
  b.yaw_rad = std::atan2(line_.b.y_m - line_.a.y_m, line_.b.x_m - line_.a.x_m);
  return b;
}

}  // namespace madori::simulation
