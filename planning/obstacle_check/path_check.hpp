#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/path.hpp"
#include "core/transform2.hpp"
#include "planning/obstacle_check/vehicle_outline.hpp"
#include "planning/obstacle_check/wall_grid.hpp"

namespace madori::planning {

/// Braking: within this distance of the vehicle something must be seen, or the vehicle could not stop before
/// it.
struct BrakingModel {
  double deceleration_mps2 = 0.8;
  double turn_deceleration_radps2 = 1.5;
  double reaction_s = 0.25;  ///< computing, sending, motor
  double scan_period_s = 0.1;

  /// From when something could be seen until the wheels begin to brake.
  [[nodiscard]] double before_braking_s() const { return reaction_s + scan_period_s; }
  [[nodiscard]] double horizon_m(double speed_mps) const {
    return speed_mps * before_braking_s() + speed_mps * speed_mps / (2.0 * deceleration_mps2);
  }
  /// The greatest speed whose horizon is `free_m`; infinite where nothing is in the way, zero where none is
  /// left.
  [[nodiscard]] double speed_within(double free_m) const {
    if (!(free_m > 0.0)) return 0.0;
    const double lost = deceleration_mps2 * before_braking_s();
    return std::sqrt(lost * lost + 2.0 * deceleration_mps2 * free_m) - lost;
  }
};

/// Where a safety scanner stops the vehicle: before its front, in its width and beside it.
struct ProtectiveField {
  double ahead_m = 0.0;  ///< of the front; 0: there is none
  double beside_m = 0.0;
};

struct CheckOptions {
  VehicleOutline vehicle;
  BrakingModel braking;
  double ends_margin_m = 0.20;   ///< kept free before and behind the vehicle
  double sides_margin_m = 0.06;  ///< ... beside it
  double turn_margin_m = 0.06;   ///< ... on all sides during a slow turn on the spot
  double care_margin_m = 0.15;   ///< something within this much more only slows the vehicle
  ProtectiveField protective;    ///< kept free as if it were part of the vehicle, of walls too
  double field_margin_m = 0.05;  ///< around it: scanners err, and no path is followed exactly
  double wall_margin_m = 0.03;   ///< to drawn walls, which lie as exactly as the drawing
  double step_m = 0.15;          ///< waypoints nearer together than this are checked once
};

/// Two headings that are checked one after the other are at most a full turn divided by this apart. A lattice
/// of headings that divides it is checked by a search exactly as it is by check_path().
inline constexpr int kCheckedHeadings = 48;

/// Kept free before and behind a vehicle of this speed: beside it as much as in a turn, and what it drives
/// before braking shows.
[[nodiscard]] inline double ends_margin_m(const CheckOptions& options, double speed_mps) {
  return std::min(options.ends_margin_m,
                  options.turn_margin_m + options.braking.before_braking_s() * speed_mps);
}

/// What is left of the ordinary margins to a vehicle that has come to stand too near to something.
struct Squeeze {
  double share = 1.0;         ///< of every margin
  double wall_slack_m = 0.0;  ///< so far drawn walls reach into it: they are not exact there
};

/// The same with less of the margins.
[[nodiscard]] inline CheckOptions with_margins(CheckOptions options, const Squeeze& squeeze) {
  options.ends_margin_m *= squeeze.share;
  options.sides_margin_m *= squeeze.share;
  options.turn_margin_m *= squeeze.share;
  options.wall_margin_m = options.wall_margin_m * squeeze.share - squeeze.wall_slack_m;
  return options;
}

/// The way ahead, checked.
struct PathCheck {
  static constexpr double kFree = std::numeric_limits<double>::infinity();

  double free_m = kFree;          ///< along the path to where the vehicle must stand
  double care_m = kFree;          ///< along the path to where it must drive with care
  std::size_t first_blocked = 0;  ///< points of the path; only where free_m is finite
  std::size_t last_blocked = 0;   ///< ... within what was checked
  bool by_wall = false;           ///< a drawn wall, not something seen
  Point2<Map> where;              ///< what blocks, Map frame

  [[nodiscard]] bool blocked() const { return free_m != kFree; }
};

/// Checks paths one after the other, in memory that it uses again.
class PathChecker {
 public:
  /// See check_path().
  [[nodiscard]] PathCheck check(const Path& path, std::size_t from, double ahead_m,
                                const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                const CheckOptions& options);

 private:
  std::vector<Point2<Map>> near_;  ///< obstacles that the path could meet
};

/// Checks points [from, ...] of the path as far as `ahead_m` along it: at every waypoint the published
/// cylinder (its radius half the vehicle's width and a margin; layout-map paper, section 3.4) and the
/// vehicle's outline at that heading must hold no obstacle and no drawn wall, so that a long vehicle's nose
/// swings clear too. Curves and turns on the spot are checked through all their headings.
[[nodiscard]] PathCheck check_path(const Path& path, std::size_t from, double ahead_m,
                                   const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                   const CheckOptions& options);

/// For a vehicle that has come to stand nearer to something than the margins, and has to get away from it:
/// what is seen within them where it stands is set back to just outside (by what looks differ by). A way
/// that is free then leads away from it, or along it, and no nearer. Left where they are: what is in the
/// protective field, and what is deeper in the outline than what is seen may be off by.
void set_back(std::vector<Point2<Map>>& obstacles, const Transform2<Map, Base>& map_from_base,
              const CheckOptions& options);

/// Whether the vehicle touches nothing on the way from one placement to another near by, the first left out:
/// through as many headings as check_path() takes.
[[nodiscard]] bool is_free_between(const Transform2<Map, Base>& from, const Transform2<Map, Base>& to,
                                   const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                   const CheckOptions& options);

/// Whether the vehicle standing so touches nothing.
[[nodiscard]] bool is_free(const Transform2<Map, Base>& map_from_base,
                           const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                           const CheckOptions& options);

}  // namespace madori::planning
