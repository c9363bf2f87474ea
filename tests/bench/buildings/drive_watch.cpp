#include "tests/bench/buildings/drive_watch.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace madori::bench {
namespace {

constexpr double kStepS = 0.02;
constexpr int kSampleSteps = 5;
constexpr int kTraceSteps = 10;

/// The pose that is compared with the truth in metres. The drawing's, as long as the cycle knows no other.
const PoseEstimate& metric_pose(const app::CycleState& state) {
  return state.pose;
}

bool is_placed(LocalizationState state) {
  return state == LocalizationState::Localized || state == LocalizationState::Degraded;
}

}  // namespace

DriveWatch::DriveWatch(const simulation::Factory& factory, DriveFigures& figures,
                       const std::filesystem::path& trace)
    : factory_(factory), figures_(figures), begun_(factory.now()) {
  if (trace.empty()) return;
  trace_.open(trace);
  trace_ << "time_s,true_x_m,true_y_m,true_deg,x_m,y_m,deg,state,mode,text\n";
}

void DriveWatch::observe(const app::CycleOutput& output, const app::CycleState& state) {
  ++step_;
  count_time(state);
  if (step_ % kSampleSteps == 0) sample_pose(state);
  look_for_contact();
  if (trace_.is_open()) write_trace(output, state);
}

void DriveWatch::count_time(const app::CycleState& state) {
  const LocalizationState health = metric_pose(state).health.state;
  const double way_m = factory_.distance_driven_m() - driven_m_;
  driven_m_ += way_m;
  figures_.time_s.add(health, kStepS);
  if (!after_lap_) return;
  figures_.time_after_lap_s.add(health, kStepS);
  figures_.way_after_lap_m.add(health, way_m);
}

void DriveWatch::sample_pose(const app::CycleState& state) {
  const PoseEstimate& pose = metric_pose(state);
  const auto truth = factory_.truth().map_from_base;
  if (!figures_.first_place_s) {
    if (!is_placed(pose.health.state)) return;
    figures_.first_place_s = time_s();
    figures_.first_place_error_m = distance_m(pose.map_from_base.translation(), truth.translation());
  }
  figures_.samples.push_back({time_s(), truth, pose.map_from_base, pose.health.state});
}

void DriveWatch::look_for_contact() {
  for (; collisions_ < factory_.collisions().size(); ++collisions_) {
    const auto& c = factory_.collisions()[collisions_];
    const bool moving = c.speed_mps >= 0.01 || c.turn_radps >= 0.01;
    (moving ? figures_.collisions_moving : figures_.collisions_standing)
        .push_back(fmt::format("{:.1f} s: {} at {:.2f} m/s and {:.2f} rad/s, ({:.2f}, {:.2f})", time_s(),
                               c.what, c.speed_mps, c.turn_radps, c.map_from_base.x_m(),
                               c.map_from_base.y_m()));
  }
}

void DriveWatch::write_trace(const app::CycleOutput& output, const app::CycleState& state) {
  const auto line = [&](const std::string& text) {
    const auto truth = factory_.truth().map_from_base;
    const auto& pose = metric_pose(state);
    const auto& at = pose.map_from_base;
    fmt::print(trace_, "{:.2f},{:.3f},{:.3f},{:.2f},{:.3f},{:.3f},{:.2f},{},{},\"{}\"\n", time_s(),
               truth.x_m(), truth.y_m(), to_deg(truth.yaw_rad()), at.x_m(), at.y_m(), to_deg(at.yaw_rad()),
               to_string(pose.health.state), to_string(state.mode), text);
  };
  for (const auto& event : output.events) line(event);
  const std::string& standstill = state.standstill.cause.text;
  if (step_ % kTraceSteps == 0) line(app::drives(state.mode) ? metric_pose(state).health.reason : standstill);
}

}  // namespace madori::bench
