#include "control/pure_pursuit/pure_pursuit.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::control {
namespace {

/// The rate from which a turn stops after `error_rad`, reaction included.
double turn_rate(double error_rad, const PursuitOptions& options) {
  const double lost = options.turn_acceleration_radps2 * options.speed.reaction_s;
  const double rate =
      std::sqrt(lost * lost + 2.0 * options.turn_acceleration_radps2 * std::abs(error_rad)) - lost;
  return std::copysign(std::min(std::max(rate, options.creep_radps), options.speed.max_turn_rate_radps),
                       error_rad);
}

double allowed_by_uncertainty(double sigma_m, const PursuitOptions& options) {
  const double doubt = (sigma_m - options.sure_sigma_m) / (options.unsure_sigma_m - options.sure_sigma_m);
  const double share = std::clamp(doubt, 0.0, 1.0);
  return options.speed.max_speed_mps + share * (options.unsure_speed_mps - options.speed.max_speed_mps);
}

/// Where the front points as a piece begins; of a piece of one point it is the heading asked for.
double facing_of(const TrackedPath& path, const PathPiece& piece) {
  return path.points()[piece.first].facing_rad();
}

/// Who looks away from where the path leads gets no nearer to it by driving on.
bool looks_away(const TrackedPath& path, const PathPlace& place, const PursuitInput& input) {
  const double off_rad = wrap_angle(path.points()[place.index].facing_rad() - input.map_from_base.yaw_rad());
  return std::abs(off_rad) > kPi / 2.0;
}

/// A vehicle that looks the other way drives forward.
PursuitInput facing_travel(PursuitInput input, bool reverse) {
  if (reverse) input.map_from_base = input.map_from_base * Transform2<Base, Base>(0.0, 0.0, kPi);
  return input;
}

/// Turns towards `direction`; true once it is reached.
bool turn_towards(double direction_rad, const PursuitInput& input, const PursuitOptions& options,
                  VelocityCommand& command) {
  const double error_rad = wrap_angle(direction_rad - input.map_from_base.yaw_rad());
  if (std::abs(error_rad) <= options.heading_tolerance_rad) return true;
  if (input.turn_free) command.angular_radps = turn_rate(error_rad, options);
  return false;
}

VelocityCommand aim(const TrackedPath& path, const PathPiece& piece, const PathPlace& place,
                    const PursuitInput& input, const PursuitOptions& options) {
  double speed = path.speed_at(piece, std::max(place.along_m, path.along_m(piece.first)));
  speed =
      std::max(speed, options.creep_mps);  // the last centimetres; what follows may still stop the vehicle
  speed = std::min({speed, allowed_by_uncertainty(input.position_sigma_m, options), input.max_speed_mps});
  const double look_m =
      std::clamp(options.look_ahead_s * speed, options.min_look_ahead_m, options.max_look_ahead_m);
  const auto base_from_map = input.map_from_base.inverse();
  const Point2<Base> target = base_from_map * path.point_at(piece, place.index, place.along_m + look_m);
  const double square = target.x_m * target.x_m + target.y_m * target.y_m;
  const double curvature = square > 1e-9 ? 2.0 * target.y_m / square : 0.0;
  speed = std::min({speed, options.speed.speed_to_stop_within(input.free_distance_m),
                    options.speed.speed_on_curve(curvature)});
  return {speed, speed * curvature};
}

}  // namespace

PursuitOutput pursue(const TrackedPath& path, const PursuitState& before, const PursuitInput& input,
                     const PursuitOptions& options) {
  PursuitOutput out;
  out.state = before;
  PursuitState& state = out.state;
  while (state.piece < path.pieces().size()) {
    const PathPiece& piece = path.pieces()[state.piece];
    if (!state.begun) {
      const double off_rad = wrap_angle(facing_of(path, piece) - input.map_from_base.yaw_rad());
      state = {state.piece, piece.first, state.piece > 0 || std::abs(off_rad) > options.turn_first_rad, true};
    }
    if (state.turning && !turn_towards(facing_of(path, piece), input, options, out.command)) {
      out.status = PursuitStatus::Turning;
      out.along_m = path.along_m(piece.first);
      return out;
    }
    state.turning = false;
    if (piece.end - piece.first > 1) {
      const PathPlace place = path.locate(piece, state.index, input.map_from_base);
      state.index = place.index;
      out.along_m = place.along_m;
      out.cross_track_m = place.cross_track_m;
      if (std::abs(place.cross_track_m) > options.off_path_m || looks_away(path, place, input)) {
        out.status = PursuitStatus::OffPath;
        return out;
      }
      if (path.along_m(piece.end - 1) - place.along_m > options.goal_tolerance_m) {
        const bool reverse = path.points()[piece.first].reverse;
        out.command = aim(path, piece, place, facing_travel(input, reverse), options);
        if (reverse) out.command.linear_mps = -out.command.linear_mps;
        return out;
      }
    }
    state = {state.piece + 1, piece.end, false, false};
  }
  out.status = PursuitStatus::Arrived;
  return out;
}

}  // namespace madori::control
