#include "simulation/factory.hpp"

#include <algorithm>
#include <cmath>

namespace madori::simulation {
namespace {

constexpr Duration kStatusPeriod = std::chrono::milliseconds(10);
constexpr double kClearM = 0.1;  ///< within which nothing stands, the vehicle need not be tried every tick

}  // namespace

FactorySetup load_setup(const std::filesystem::path& site_folder, const std::filesystem::path& scenario) {
  const mapping::Site site = mapping::load_scaled_site(site_folder);
  FactorySetup setup;
  setup.scenario = load_scenario(scenario);
  setup.seed = setup.scenario.seed;
  if (setup.scenario.building.walls_file.empty())
    setup.walls = mapping::load_walls(site_folder / "walls.csv");
  setup.vehicle = site.vehicle;
  setup.sensors = site.sensors;
  return setup;
}

Factory::Factory(const FactorySetup& setup)
    : setup_(setup),
      epoch_(setup.epoch),
      world_(setup.walls, setup.scenario),
      vehicle_(setup.vehicle, setup.scenario.vehicle, setup.seed),
      sensors_(setup.scenario, setup.vehicle, setup.sensors, setup.seed, setup.epoch),
      mailbox_(setup.scenario.faults, setup.seed),
      drive_(setup.scenario.vehicle) {
  for (const auto& mover : setup.scenario.movers) movers_.emplace_back(mover, world_.frames());
  for (const auto& door : setup.scenario.doors) doors_.emplace_back(door, world_.frames());
  state_.pose = world_.frames().building_pose(setup.scenario.map_from_plan * setup.scenario.start);
  track_.add(now_, state_.pose);
  drive_.tick(state_, false, {}, now_);
  advance_traffic();
}

void Factory::step(Duration dt) {
  for (target_ += dt; now_ + kTick <= target_;) tick(nullptr);
}

void Factory::step(Duration dt, const WheelCommand& command) {
  for (target_ += dt; now_ + kTick <= target_;) tick(&command);
}

void Factory::tick(const WheelCommand* command) {
  now_ += kTick;
  apply_kidnapping();
  advance_traffic();
  drive_.tick(state_, !touching_.empty(), trouble(), now_);
  advance_vehicle(command);
  track_.add(now_, state_.pose);
  sensors_.measure_until(now_, View{world_, track_, bodies_}, mailbox_);
  if (now_ % kStatusPeriod == Duration(0)) mailbox_.send(Device::Drive, drive_.status_frame(), now_);
}

void Factory::advance_traffic() {
  const mapping::VehicleRecord& v = vehicle_.record();
  const VehicleCircle circle{state_.pose * Point2<Base>{v.length_m / 2.0 - v.base_to_rear_m, 0.0},
                             std::hypot(v.length_m, v.width_m) / 2.0};
  const double now_s = to_seconds(now_), dt_s = to_seconds(kTick);
  for (Mover& mover : movers_) mover.advance(now_s, dt_s, circle);
  for (Door& door : doors_) door.advance(now_s, dt_s, circle, movers_);
  bodies_.clear();
  for (const Mover& mover : movers_) bodies_.push_back(mover.body());
  for (const Door& door : doors_)
    if (auto leaf = door.leaf()) bodies_.push_back(std::move(*leaf));
}

/// What was asked one dead time ago.
WheelCommand Factory::obeyed(const WheelCommand& asked) {
  const auto ticks = static_cast<std::size_t>(vehicle_.dead_time_s() / to_seconds(kTick) + 0.5);
  unheard_.push_back(asked);
  if (unheard_.size() <= ticks) return {};
  const WheelCommand now = unheard_.front();
  unheard_.pop_front();
  return now;
}

void Factory::advance_vehicle(const WheelCommand* command) {
  const WheelCommand asked = obeyed(command != nullptr ? *command : drive_.asked());
  const auto tick_number = static_cast<std::uint64_t>(now_ / kTick);
  VehicleState next = vehicle_.advance(state_, asked, to_seconds(kTick), extra_slip(), tick_number);
  const bool moves = next.pose.x_m() != state_.pose.x_m() || next.pose.y_m() != state_.pose.y_m() ||
                     next.pose.yaw_rad() != state_.pose.yaw_rad();
  if (!moves && bodies_.empty()) return void(state_ = next);
  if (moves) look_around(next.pose);
  const std::string hit = touched_at(next.pose, moves);
  if (!hit.empty() && touching_.empty())
    collisions_.push_back(
        {now(), hit, std::abs(next.linear_mps), truth().map_from_base, std::abs(next.angular_radps)});
  // What was touched already does not hold the vehicle from leaving; something new stops it where it was.
  if (!hit.empty() && moves && touched_at(state_.pose, true).empty()) {
    next.pose = state_.pose;
    next.left_radps = next.right_radps = next.linear_mps = next.angular_radps = 0.0;
  }
  touching_ = hit;
  driven_m_ += distance_m(state_.pose.translation(), next.pose.translation());
  state_ = next;
}

std::string Factory::touched_at(const Transform2<Building, Base>& pose, bool with_walls) const {
  const HeightRange body = vehicle_.body();
  if (with_walls && !is_clear(pose))
    if (const Obstacle* wall = world_.obstacles().find(vehicle_.footprint(pose), body)) return wall->name;
  const double reach = std::hypot(vehicle_.record().length_m, vehicle_.record().width_m);
  for (const Body& b : bodies_) {
    if (distance_m(b.centre, pose.translation()) > reach + b.reach_m()) continue;
    if (b.z.low_m < body.high_m && b.z.high_m > body.low_m && overlap(vehicle_.footprint(pose), outline(b)))
      return b.name;
  }
  return {};
}

/// Remembers a place with nothing that never moves within kClearM of the vehicle's outline.
void Factory::look_around(const Transform2<Building, Base>& pose) {
  if (is_clear(pose)) return;
  clear_around_.reset();
  if (world_.obstacles().find(vehicle_.footprint(pose, kClearM), vehicle_.body()) == nullptr)
    clear_around_ = pose;
}

bool Factory::is_clear(const Transform2<Building, Base>& pose) const {
  if (!clear_around_) return false;
  const double turn_rad = std::abs(wrap_angle(pose.yaw_rad() - clear_around_->yaw_rad()));
  const double reach_m = std::hypot(vehicle_.record().length_m, vehicle_.record().width_m);
  return distance_m(pose.translation(), clear_around_->translation()) + turn_rad * reach_m < kClearM;
}

DriveTrouble Factory::trouble() const {
  const double now_s = to_seconds(now_);
  DriveTrouble t;
  if (const FaultSpec* stuck = mailbox_.active(FaultKind::StuckEncoder, Device::Drive, now_s)) {
    t.left_encoder_stuck = stuck->wheel != Wheel::Right;
    t.right_encoder_stuck = stuck->wheel != Wheel::Left;
  }
  t.emergency_stop = mailbox_.active(FaultKind::EmergencyStop, Device::Drive, now_s) != nullptr;
  t.fault = mailbox_.active(FaultKind::DriveFault, Device::Drive, now_s) != nullptr;
  return t;
}

ExtraSlip Factory::extra_slip() const {
  const FaultSpec* slip = mailbox_.active(FaultKind::Slip, Device::Drive, to_seconds(now_));
  if (slip == nullptr) return {};
  return {slip->wheel != Wheel::Right ? slip->share : 0.0, slip->wheel != Wheel::Left ? slip->share : 0.0};
}

void Factory::apply_kidnapping() {
  const auto& faults = mailbox_.faults();
  const double now_s = to_seconds(now_), before_s = to_seconds(now_ - kTick);
  for (const FaultSpec& f : faults)
    if (f.kind == FaultKind::Kidnap && f.at_s <= now_s &&
        (f.at_s > before_s || (f.at_s == 0.0 && before_s <= 0.0)))
      set_pose(setup_.scenario.map_from_plan * f.pose);
}

void Factory::set_pose(const Transform2<Map, Base>& map_from_base) {
  state_.pose = world_.frames().building_pose(map_from_base);
  state_.left_radps = state_.right_radps = state_.linear_mps = state_.angular_radps = 0.0;
  track_.clear();
  track_.add(now_, state_.pose);
  touching_.clear();
}

void Factory::inject(FaultSpec fault) {
  if (fault.kind == FaultKind::Kidnap) return set_pose(setup_.scenario.map_from_plan * fault.pose);
  fault.at_s += to_seconds(now_);
  mailbox_.add_fault(fault, to_seconds(now_));
}

void Factory::add_mover(const MoverSpec& spec) {
  movers_.emplace_back(spec, world_.frames());
}

void Factory::remove_mover(const std::string& name) {
  std::erase_if(movers_, [&](const Mover& mover) { return mover.name() == name; });
}

bool Factory::is_free(const Transform2<Map, Base>& map_from_base) const {
  return touched_at(world_.frames().building_pose(map_from_base), true).empty();
}

void Factory::drive_write(std::span<const std::uint8_t> bytes) {
  if (mailbox_.active(FaultKind::Silence, Device::Drive, to_seconds(now_)) != nullptr) return;
  drive_.receive(bytes, now_);
}

std::vector<DevicePacket> Factory::take_packets() {
  return mailbox_.take(now_, epoch_);
}

GroundTruth Factory::truth() const {
  return {now(), world_.frames().map_pose(state_.pose), state_.pose, state_.linear_mps, state_.angular_radps};
}

}  // namespace madori::simulation
