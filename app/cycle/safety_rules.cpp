#include "app/cycle/safety_rules.hpp"

#include <algorithm>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

/// No step came for so long that what was heard is of another time.
bool after_a_gap(const CycleState& state, const CycleInput& /*input*/, const CycleConfig& /*config*/) {
  return state.gap.has_value();
}

bool drive_is_silent(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return is_silent(state.drive_heard, input.now, config.drive_silent_s);
}

bool drive_is_deaf(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return is_drive_deaf(state, input.now, config);
}

bool drive_is_late(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return is_drive_late(state, input.now, config);
}

bool wheels_are_untold(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return are_wheels_untold(state, input.now, config);
}

bool lidar_is_silent(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return is_silent(state.lidar_heard, input.now, config.lidar_silent_s);
}

bool mounting_is_wrong(const CycleState& state, const CycleInput& /*input*/, const CycleConfig& /*config*/) {
  return mounting_forbids(state.mounting);
}

Notice what_is_wrong(const CycleState& state, const CycleInput& /*input*/, const CycleConfig& config) {
  return mounting_notice(*state.mounting.doubt(), config);
}

Notice who_is_silent(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const std::string names = config.lidars.size() > 1 ? silent_lidars(state, input.now, config) : "";
  return names.empty() ? notice(Cause::LidarSilent) : notice(Cause::LidarsSilent, {{"name", names}});
}

}  // namespace

bool field_is_entered(const CycleState& /*state*/, const CycleInput& input, const CycleConfig& /*config*/) {
  return input.protective_stop;
}

std::vector<SafetyRule> standard_safety_rules() {
  return {
      {entry(Cause::TimeGap), entry(Remedy::ByItself), true, after_a_gap},
      {entry(Cause::ProtectiveField), entry(Remedy::ClearField), false, field_is_entered},
      {entry(Cause::DriveSilent), entry(Remedy::CheckDrive), true, drive_is_silent},
      {entry(Cause::DriveDeaf), entry(Remedy::CheckDrive), true, drive_is_deaf},
      {entry(Cause::DriveLate), entry(Remedy::CheckDrive), true, drive_is_late},
      {entry(Cause::WheelsUntold), entry(Remedy::CheckDrive), true, wheels_are_untold},
      {entry(Cause::LidarSilent), entry(Remedy::CheckLidar), false, lidar_is_silent, who_is_silent},
      {entry(Cause::LidarHeight), entry(Remedy::CorrectMounting), false, mounting_is_wrong, what_is_wrong},
  };
}

const SafetyRule* forbidding_rule(const CycleState& state, const CycleInput& input, const CycleConfig& config,
                                  bool by_hand) {
  const auto rule = std::ranges::find_if(config.safety_rules, [&](const SafetyRule& r) {
    return (r.by_hand || !by_hand) && r.holds(state, input, config);
  });
  return rule == config.safety_rules.end() ? nullptr : &*rule;
}

}  // namespace madori::app
