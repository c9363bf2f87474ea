#include "app/pose/pose_store.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "app/covariance_yaml.hpp"
#include "core/result.hpp"
#include "mapping/site/strict_yaml.hpp"

namespace madori::app {
namespace {

constexpr int kToleratedCounts = control::wire::kCountsPerTurn / 720;
constexpr double kFarM = 1e6;
constexpr CovarianceKeys kCovariance{"xx", "xy", "xt", "yy", "yt", "tt"};

long long counts(std::int16_t turns, std::uint16_t angle) {
  return static_cast<long long>(turns) * control::wire::kCountsPerTurn + angle;
}

StoredPose read(const std::filesystem::path& file) {
  auto yaml = mapping::StrictYaml::load(file);
  StoredPose pose;
  pose.stamp = stamp_from_seconds(yaml.number("stamp_s", 0.0, 1e11));
  const double x = yaml.number("x_m", -kFarM, kFarM);
  const double y = yaml.number("y_m", -kFarM, kFarM);
  pose.map_from_base = {x, y, yaml.number("yaw_rad", -2.0 * kPi, 2.0 * kPi)};
  pose.covariance = read_covariance(yaml, kCovariance, kFarM);
  auto wheels = yaml.section("wheels");
  pose.wheels = {static_cast<std::uint16_t>(wheels.integer("left_angle", 0, 65535)),
                 static_cast<std::uint16_t>(wheels.integer("right_angle", 0, 65535)),
                 static_cast<std::int16_t>(wheels.integer("left_turns", -32768, 32767)),
                 static_cast<std::int16_t>(wheels.integer("right_turns", -32768, 32767))};
  wheels.refuse_unknown_keys();
  pose.walls = yaml.text("walls_fingerprint");
  yaml.refuse_unknown_keys();
  return pose;
}

}  // namespace

WheelCounters counters_of(const control::wire::Status& status) {
  return {status.left_angle, status.right_angle, status.left_turns, status.right_turns};
}

bool same_place(const WheelCounters& a, const WheelCounters& b) {
  return std::llabs(counts(a.left_turns, a.left_angle) - counts(b.left_turns, b.left_angle)) <=
             kToleratedCounts &&
         std::llabs(counts(a.right_turns, a.right_angle) - counts(b.right_turns, b.right_angle)) <=
             kToleratedCounts;
}

std::string stored_pose_yaml(const StoredPose& p) {
  std::string text = "# Where the vehicle stood last. Used at the start only where nothing moved since.\n";
  text += fmt::format("stamp_s: {:.3f}\nx_m: {:.6f}\ny_m: {:.6f}\nyaw_rad: {:.8f}\n", to_seconds(p.stamp),
                      p.map_from_base.x_m(), p.map_from_base.y_m(), p.map_from_base.yaw_rad());
  text += covariance_yaml(p.covariance, kCovariance);
  text += fmt::format("wheels: {{left_angle: {}, right_angle: {}, left_turns: {}, right_turns: {}}}\n",
                      p.wheels.left_angle, p.wheels.right_angle, p.wheels.left_turns, p.wheels.right_turns);
  return text + fmt::format("walls_fingerprint: \"{}\"\n", p.walls);
}

std::optional<OperatorCommand> PoseRecall::on_status(const control::wire::Status& status) {
  const auto stored = std::exchange(stored_, std::nullopt);
  if (!stored) return std::nullopt;
  if (!same_place(stored->wheels, counters_of(status))) {
    verdict_ = "the wheels have turned since the last run: looking for the place anew";
    return std::nullopt;
  }
  verdict_ = "nothing has moved since the last run: trying the place of then";
  constexpr PoseSigma kStored{0.1, 0.05};
  const auto& pose = stored->map_from_base;
  return OperatorCommand{OperatorWord::SetPose, {}, {pose.translation(), pose.yaw_rad(), kStored}};
}

LoadedPose load_stored_pose(const std::filesystem::path& site, const std::string& walls) {
  const auto file = site / kPoseFile;
  if (!std::filesystem::exists(file)) return {};
  const std::string anew = "; the place is looked for on the whole drawing";
  try {
    StoredPose pose = read(file);
    if (pose.walls != walls) return {std::nullopt, "the drawing has changed since the last run" + anew};
    return {std::move(pose), ""};
  } catch (const Error& e) {
    return {std::nullopt, std::string(e.what()) + anew};
  }
}

}  // namespace madori::app
