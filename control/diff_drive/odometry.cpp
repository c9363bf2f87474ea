#include "control/diff_drive/odometry.hpp"

#include <cmath>
#include <string>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::control {
namespace {

constexpr int kRowOfARestart = 16;
constexpr double kRadPerCount = 2.0 * kPi / wire::kCountsPerTurn;

void require_positive(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0)
    throw Error(name, "is " + std::to_string(value), "give a positive number");
}

/// Angle and turns as one number of counts; it wraps at 2^30 counts (65,536 turns).
std::uint32_t counts(std::uint16_t angle, std::int16_t turns) {
  return (static_cast<std::uint32_t>(static_cast<std::uint16_t>(turns)) << 14U) | angle;
}

/// The shorter way round from one count to the other.
double counts_between_rad(std::uint32_t from, std::uint32_t to) {
  const auto shifted =
      static_cast<std::int32_t>((to - from) << 2U);  // 30 bits to the top: the sign falls out
  return kRadPerCount * (shifted >> 2);
}

}  // namespace

DiffDriveOdometry::DiffDriveOdometry(const OdometryOptions& options) : options_(options) {
  require_positive("left wheel radius", options.wheels.left_radius_m);
  require_positive("right wheel radius", options.wheels.right_radius_m);
  require_positive("half wheel separation", options.wheels.half_separation_m);
  require_positive("largest wheel speed", options.max_wheel_speed_radps);
  require_positive("longest gap", options.max_gap_s);
}

DiffDriveOdometry::Step DiffDriveOdometry::step_between(const wire::Status& from, const wire::Status& to) {
  return {
      counts_between_rad(counts(from.left_angle, from.left_turns), counts(to.left_angle, to.left_turns)),
      counts_between_rad(counts(from.right_angle, from.right_turns), counts(to.right_angle, to.right_turns)),
      static_cast<double>(to.time_us - from.time_us) * 1e-6};
}

bool DiffDriveOdometry::possible(const Step& step) const {
  const double most_rad = options_.max_wheel_speed_radps * step.time_s + options_.reading_noise_rad;
  return std::abs(step.left_rad) <= most_rad && std::abs(step.right_rad) <= most_rad;
}

OdometryVerdict DiffDriveOdometry::update(const wire::Status& status, Stamp received) {
  if (!reference_) return restart(status, received, OdometryVerdict::First);
  const auto ahead = static_cast<std::int16_t>(status.sequence - last_sequence_);
  const double elapsed_s = static_cast<std::int32_t>(status.time_us - reference_->time_us) * 1e-6;
  if (ahead <= 0 && elapsed_s <= 0.0 && elapsed_s > -options_.max_gap_s) {
    // A serial line overtakes nothing: one old frame is an echo, a row of new old ones is a controller that
    // rebooted.
    late_row_ += ahead < 0 ? 1 : 0;
    if (late_row_ < kRowOfARestart) return ++counters_.duplicates, OdometryVerdict::Duplicate;
    return restart(status, received, OdometryVerdict::Restarted);
  }
  late_row_ = 0;
  if (ahead > 0) counters_.dropped += static_cast<std::uint64_t>(ahead) - 1U;
  if (elapsed_s < 0.0 || elapsed_s > options_.max_gap_s)
    return restart(status, received, OdometryVerdict::Restarted);
  last_sequence_ = status.sequence;
  const Step step = step_between(*reference_, status);
  if (possible(step)) return advance(step, status, received);
  if (doubted_ && possible(step_between(*doubted_, status)))
    return restart(status, received, OdometryVerdict::Restarted);
  doubted_ = status;
  ++counters_.jumps;
  return OdometryVerdict::Jump;
}

OdometryVerdict DiffDriveOdometry::advance(const Step& step, const wire::Status& status, Stamp received) {
  reading_.odom_from_base =
      reading_.odom_from_base * arc_step(options_.wheels, step.left_rad, step.right_rad);
  reading_.stamp = received;
  ++counters_.moved;
  if (step.time_s > 0.0) {
    const double left_m = options_.wheels.left_radius_m * step.left_rad;
    const double right_m = options_.wheels.right_radius_m * step.right_rad;
    linear_mps_ = (left_m + right_m) / 2.0 / step.time_s;
    angular_radps_ = (right_m - left_m) / (2.0 * options_.wheels.half_separation_m) / step.time_s;
  }
  reference_ = status;
  doubted_.reset();
  return OdometryVerdict::Moved;
}

OdometryVerdict DiffDriveOdometry::restart(const wire::Status& status, Stamp received,
                                           OdometryVerdict verdict) {
  reference_ = status;
  doubted_.reset();
  last_sequence_ = status.sequence;
  late_row_ = 0;
  reading_.stamp = received;
  linear_mps_ = angular_radps_ = 0.0;
  if (verdict == OdometryVerdict::Restarted) ++counters_.restarts;
  return verdict;
}

}  // namespace madori::control
