#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "control/diff_drive/kinematics.hpp"
#include "control/drive_link/command_lag.hpp"
#include "control/drive_link/controller.hpp"
#include "core/segment_distance.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/rolling_vehicle.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::test {

/// Hands the cycle the true pose: for tests of planning, control and the cycle alone.
class TruePose : public app::PoseSource {
 public:
  explicit TruePose(const RollingVehicle& vehicle) : vehicle_(vehicle) {}
  PoseEstimate on_odometry(const OdometryReading& reading) override { return now(reading.stamp); }
  void on_cloud(const PointCloud<Base>& /*cloud*/, const Transform2<Odom, Base>& /*odom*/) override {}
  void set_pose(const Transform2<Map, Base>& pose, const PoseSigma& /*sigma*/) override { given = pose; }
  void search_anew() override {}
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return places; }
  std::optional<Transform2<Map, Base>> given;
  std::vector<PoseHypothesis> places;
  LocalizationState state = LocalizationState::Localized;
  double place = 1.0;             ///< as LocalizationHealth says
  Transform2<Base, Base> beside;  ///< what it believes to stand at, in the true pose

 private:
  [[nodiscard]] PoseEstimate now(Stamp stamp) const {
    PoseEstimate pose{
        stamp, vehicle_.pose() * beside, Eigen::Matrix3d::Identity() * 1e-6, {state, "", place}};
    if (state != LocalizationState::Localized) pose.health.reason = "told so by the test";
    return pose;
  }
  const RollingVehicle& vehicle_;
};

/// The reference vehicle in a toy world, lock-step at 50 Hz, with the real drive protocol and controller.
class ToyVehicle {
 public:
  static constexpr double kStep_s = 0.02;

  ToyVehicle(app::CycleConfig cycle_config, Transform2<Map, Base> start, std::uint32_t seed = 1)
      : config(std::move(cycle_config)), rolling(start), random_(seed), state_(make_state()) {
    lidar.height_m = config.lidars.front().mounting.z_m;
  }

  /// One step of 20 ms. Orders are worked off as the order store would.
  void step() {
    time_s_ += kStep_s;
    const auto micros = static_cast<std::uint32_t>(std::llround((time_s_ - drive_started_s) * 1e6));
    turn_wheels();
    controller_.tick({emergency_stop, bumper, drive_faults, angle(left_rad_), angle(right_rad_), battery_mv},
                     micros);
    (void)controller_.next_status();  // one every 10 ms, heard or not
    auto status = controller_.next_status();
    if (each_status) each_status(status);
    if (!drive_silent) waiting_.push_back(status);
    if (hung) return;
    app::CycleInput input;
    input.now = stamp_from_seconds(1'000.0 + time_s_ + clock_s);
    input.drive = std::exchange(waiting_, {});
    if (!input.drive.empty()) behind_ = lag_.behind(input.drive.back().command_sequence, input.now);
    input.drive_behind = behind_;
    now_ = input.now;
    if (++ticks_ % 5 == 0 && !lidar_silent)
      input.clouds.push_back(cloud(input.now - duration_from_seconds(cloud_age_s)));
    input.commands = std::exchange(commands, {});
    input.protective_stop = protective_stop;
    if (order && order->state == app::OrderState::Running) input.order = order;
    input.detour = std::exchange(detour_, std::nullopt);
    if (record) inputs.push_back(input);
    auto [after, out] = app::step(std::move(state_), input, config);
    state_ = std::move(after);
    output = std::move(out);
    if (on_step) on_step(input, output, state_);
    answer(micros);
  }

  /// Steps until `done` or a time is over; whether it was done.
  bool run_until(const std::function<bool()>& done, double limit_s) {
    for (double t = 0.0; t < limit_s; t += kStep_s) {
      step();
      if (each_step) each_step();
      if (done()) return true;
    }
    return false;
  }
  void say(app::OperatorWord word) { commands.push_back({word, {}}); }
  void drive_to(std::vector<app::OrderStop> stops, int repeat = 1) {
    order = app::Order{++orders_, std::move(stops), repeat, app::OrderState::Running, 0, 0, ""};
  }
  /// The drive's controller starts anew, as after a brown-out: idle, and armed only by a command that does
  /// not enable it.
  void count_frames() { (void)controller_.next_status(), (void)controller_.next_status(); }
  void restart_drive() { controller_ = {}; }
  [[nodiscard]] control::wire::DriveState drive_state() const { return controller_.state(); }
  [[nodiscard]] std::uint16_t newest_command() const { return sequence_; }
  void set_source(std::unique_ptr<app::PoseSource> source) {
    pose = nullptr;
    state_.localization = std::move(source);
  }
  [[nodiscard]] bool delivered() const { return order && order->state == app::OrderState::Done; }
  [[nodiscard]] const app::CycleState& state() const { return state_; }
  [[nodiscard]] double time_s() const { return time_s_; }

  /// Distance from the vehicle's outline to the nearest body; zero in contact.
  [[nodiscard]] double clearance_m() const {
    const auto& v = config.check.vehicle;
    const std::array<Point2<Base>, 4> corners{{{v.front_m, v.half_width_m},
                                               {-v.rear_m, v.half_width_m},
                                               {-v.rear_m, -v.half_width_m},
                                               {v.front_m, -v.half_width_m}}};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) {
      const Segment2<Map> side = rolling.pose() * Segment2<Base>{corners[i], corners[(i + 1) % 4]};
      for (const Post& post : lidar.posts)
        if (post.bottom_m < v.height_m)
          nearest = std::min(nearest, distance_m(side, post.at) - post.radius_m);
      for (const LyingBody& body : lidar.bodies)
        for (const auto& edge : body.edges()) nearest = std::min(nearest, distance_m(side, edge));
    }
    return std::max(0.0, nearest);
  }

  app::CycleConfig config;
  RollingVehicle rolling;
  ToyLidar lidar;
  bool protective_stop = false;
  bool emergency_stop = false, bumper = false, drive_silent = false, lidar_silent = false;
  bool drive_deaf = false;        ///< commands do not reach it
  std::size_t commands_wait = 0;  ///< steps that each command needs to reach it
  bool hung = false;              ///< the cycle takes no step
  std::uint16_t drive_faults = 0;
  std::uint16_t battery_mv = 25'000;
  double right_wheel_share = 1.0;  ///< of what it is told: a weak motor, a dead one
  double clock_s = 0.0;            ///< what was added to the computer's clock
  double cloud_age_s = 0.0;        ///< revolutions are stamped so long ago
  double drive_started_s = 0.0;    ///< when its power came: its clock counts from there
  std::vector<app::OperatorCommand> commands;
  std::optional<app::Order> order;
  app::CycleOutput output;
  bool record = false;
  std::vector<app::CycleInput> inputs;
  std::vector<VelocityCommand> driven;  ///< the command of every step
  std::vector<std::string> events;
  std::function<void()> each_step;
  std::function<void(control::wire::Status&)> each_status;  ///< may change what the drive tells
  std::function<void(const app::CycleInput&, const app::CycleOutput&, const app::CycleState&)> on_step;
  TruePose* pose = nullptr;

 private:
  app::CycleState make_state() {
    auto source = std::make_unique<TruePose>(rolling);
    pose = source.get();
    return {config, std::move(source)};
  }
  void turn_wheels() {
    const auto& wheels = config.odometry.wheels;
    const VelocityCommand wanted = control::vehicle_velocity(
        wheels, {controller_.left_uradps() * 1e-6, right_wheel_share * controller_.right_uradps() * 1e-6});
    rolling.move(wanted, kStep_s);
    const auto turned = control::wheel_speeds(wheels, rolling.speed());
    left_rad_ += turned.left_radps * kStep_s;
    right_rad_ += turned.right_radps * kStep_s;
  }
  static std::uint16_t angle(double rad) {
    const double turns = rad / (2.0 * kPi);
    const auto counts = std::llround((turns - std::floor(turns)) * control::wire::kCountsPerTurn);
    return static_cast<std::uint16_t>(counts % control::wire::kCountsPerTurn);
  }
  PointCloud<Lidar> cloud(Stamp now) {
    const PointCloud<Base> base = lidar.scan(rolling.pose(), now, random_);
    PointCloud<Lidar> result{now, base.points};
    for (CloudPoint& p : result.points) p.z_m -= static_cast<float>(lidar.height_m);
    return result;
  }
  void answer(std::uint32_t micros) {
    const auto wheels = control::wheel_speeds(config.odometry.wheels, output.command);
    auto& frame = on_the_way_.emplace_back(control::wire::kMaxFrame);
    frame.resize(encode(
        control::wire::Command{++sequence_, output.enable, static_cast<std::int32_t>(wheels.left_radps * 1e6),
                               static_cast<std::int32_t>(wheels.right_radps * 1e6)},
        frame.data()));
    lag_.told(sequence_, now_);
    for (; on_the_way_.size() > commands_wait; on_the_way_.pop_front())
      if (!drive_silent && !drive_deaf)
        for (const std::uint8_t byte : on_the_way_.front()) controller_.receive(byte, micros);
    driven.push_back(output.command);
    events.insert(events.end(), output.events.begin(), output.events.end());
    if (output.detour_wanted) {
      planning::DetourOptions options;
      options.free_space.max_checks = 50'000;
      detour_ = planning::plan_detour(*output.detour_wanted, config.check, options);
    }
    if (output.stop_done && ++order->next_stop == order->stops.size()) {
      order->next_stop = 0;
      if (++order->round == order->repeat) order->state = app::OrderState::Done;
    }
  }

  std::mt19937 random_;
  control::wire::Controller controller_;
  double time_s_ = 0.0, left_rad_ = 0.0, right_rad_ = 0.0;
  int ticks_ = 0;
  std::int64_t orders_ = 0;
  std::uint16_t sequence_ = 0;
  std::deque<std::vector<std::uint8_t>> on_the_way_;  ///< commands
  control::CommandLag lag_;
  Duration behind_{};
  Stamp now_{};
  std::optional<planning::DetourAnswer> detour_;
  std::vector<control::wire::Status> waiting_;
  app::CycleState state_;
};

/// The reference vehicle and a VLP-16 at 0.9 m, on routes given as CSV.
inline app::CycleConfig toy_config(planning::RouteGraph routes) {
  app::CycleConfig config;
  config.routes = std::move(routes);
  config.lidars = {spinning_lidar({0.0, 0.0, 0.9, 0.0})};
  return config;
}

}  // namespace madori::test
