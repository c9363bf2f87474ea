#include "localization/mounting/mounting_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/angle.hpp"
#include "core/median.hpp"
#include "localization/mounting/mounting_problem.hpp"
#include "localization/mounting/mounting_start.hpp"

namespace madori::localization {
namespace {

constexpr std::size_t kMostSweeps = 160;  // of a lidar
constexpr std::size_t kFewestSweeps = 12;
constexpr double kEveryRad = to_rad(4.0);
constexpr double kEveryM = 0.06;
constexpr int kFewestWalls = 8;
constexpr double kYawKnownRad = to_rad(0.5);
constexpr double kPlaceKnownM = 0.02;

Stamp end_of(const PointCloud<Lidar>& sweep) {
  const double last_s = sweep.points.empty() ? 0.0 : static_cast<double>(sweep.points.back().time_offset_s);
  return sweep.stamp + duration_from_seconds(last_s);
}

/// The sweeps of a lidar that are worth using: one each few degrees or centimetres.
std::vector<const PointCloud<Lidar>*> choose_sweeps(const std::vector<PointCloud<Lidar>>& sweeps,
                                                    std::size_t lidar, const WheelPath& path) {
  std::vector<const PointCloud<Lidar>*> chosen;
  Transform2<Odom, Base> last;
  for (const auto& sweep : sweeps) {
    if (sweep.lidar != lidar || sweep.points.size() < 30) continue;
    const auto here = path.at(end_of(sweep));
    const auto since = last.inverse() * here;
    if (!chosen.empty() && std::abs(since.yaw_rad()) < kEveryRad &&
        std::hypot(since.x_m(), since.y_m()) < kEveryM)
      continue;
    chosen.push_back(&sweep);
    last = here;
  }
  const std::size_t kept = std::min(chosen.size(), kMostSweeps);
  for (std::size_t i = 0; i < kept; ++i) chosen[i] = chosen[i * chosen.size() / kept];
  chosen.resize(kept);
  return chosen;
}

/// The floor as most of the sweeps agree on it.
std::optional<FloorSeen> floor_of(const std::vector<const PointCloud<Lidar>*>& sweeps,
                                  const LidarModel& lidar) {
  std::vector<FloorSeen> seen;
  for (const auto* sweep : sweeps)
    if (const auto floor = find_floor(*sweep, lidar)) seen.push_back(*floor);
  if (seen.size() < 3 || 3 * seen.size() < sweeps.size()) return std::nullopt;
  const auto middle = [&](double FloorSeen::*of) {
    std::vector<double> values;
    for (const auto& floor : seen) values.push_back(floor.*of);
    return median_of(values);
  };
  FloorSeen floor{middle(&FloorSeen::height_m), middle(&FloorSeen::slope_x), middle(&FloorSeen::slope_y)};
  std::vector<double> off;
  for (const auto& one : seen) {
    off.push_back(std::abs(one.height_m - floor.height_m));
    floor.points += one.points;
  }
  constexpr double kUnevenM = 0.003;  // a floor, and a lidar's ranges on it
  floor.sigma_m = std::hypot(kUnevenM, 1.4826 * median_of(off) / std::sqrt(static_cast<double>(seen.size())));
  return floor;
}

/// Of one lidar: its sweeps, and the floor below it.
struct LidarLook {
  std::vector<const PointCloud<Lidar>*> sweeps;
  std::optional<FloorSeen> floor;
};

std::vector<WallPiece> pieces_of(const PointCloud<Lidar>& sweep, const LidarModel& lidar,
                                 const LidarLook& look, const WheelPath& path,
                                 const Transform2<Base, Lidar>& mount) {
  const auto end_from_odom = mount.inverse() * path.at(end_of(sweep)).inverse();
  return wall_pieces(sweep, lidar, look.floor,
                     [&](Stamp moment) { return end_from_odom * path.at(moment) * mount; });
}

Transform2<Base, Lidar> mount_of(const CalibrationState& state, std::size_t lidar) {
  const auto& m = state.base_from_lidar[lidar];
  return {m[0], m[1], m[2]};
}

/// The mounting of one lidar and where the vehicle was at its sweeps, from its own motion.
void begin_lidar(CalibrationState& state, std::size_t lidar, const LidarModel& model, const LidarLook& look,
                 const WheelPath& path, Stamp begun) {
  std::vector<std::vector<WallPiece>> pieces;
  std::vector<double> turned;
  std::vector<Transform2<Odom, Base>> vehicle;
  double sum = 0.0;
  for (const auto* sweep : look.sweeps) {
    pieces.push_back(pieces_of(*sweep, model, look, path, model.mounting.base_from_lidar()));
    vehicle.push_back(path.at(end_of(*sweep)));
    if (vehicle.size() > 1)
      sum += wrap_angle(vehicle.back().yaw_rad() - vehicle[vehicle.size() - 2].yaw_rad());
    turned.push_back(sum);
  }
  const auto own = track_lidar(pieces, turned, model);
  const auto mount = closed_form_mounting(own, vehicle, model.mounting);
  state.base_from_lidar[lidar] = {mount.x_m(), mount.y_m(), mount.yaw_rad()};
  const auto first = path.at(begun).inverse() * vehicle.front();  // of all lidars, where this one begins
  double yaw = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto since = first * mount * (own.front().inverse() * own[k]) * mount.inverse();
    yaw += wrap_angle(since.yaw_rad() - yaw);
    state.sweeps.push_back({lidar, end_of(*look.sweeps[k]), pieces[k], {since.x_m(), since.y_m(), yaw}});
  }
}

WheelGeometry scaled(const WheelGeometry& believed, const CalibrationState& state) {
  return {believed.left_radius_m * (1.0 + state.wheels[0]), believed.right_radius_m * (1.0 + state.wheels[1]),
          believed.half_separation_m * (1.0 + state.wheels[2])};
}

/// Each sweep's pieces once more, now that the motion within it is known.
void deskew_again(CalibrationState& state, const std::vector<LidarLook>& looks,
                  const std::vector<LidarModel>& lidars, const WheelPath& path) {
  std::vector<std::size_t> next(looks.size(), 0);
  for (CalibrationSweep& sweep : state.sweeps) {
    const auto* cloud = looks[sweep.lidar].sweeps[next[sweep.lidar]++];
    sweep.pieces =
        pieces_of(*cloud, lidars[sweep.lidar], looks[sweep.lidar], path, mount_of(state, sweep.lidar));
  }
}

/// Enough walls, and at least one piece's worth of them across the others: along a corridor no motion is
/// seen, and to go back along it looks as to go forward.
bool are_enough(const std::vector<RoomWall>& walls) {
  double c = 0.0, s = 0.0;  // of the doubled angles: opposite walls have one direction
  for (const RoomWall& wall : walls)
    c += std::cos(2.0 * wall.normal_rad), s += std::sin(2.0 * wall.normal_rad);
  const auto count = static_cast<double>(walls.size());
  const double across = 0.5 * (count - std::hypot(c, s));
  return count >= kFewestWalls && across >= 1.0;
}

constexpr double kMostOff = 3.0;  // sigmas

/// What was seen makes one room, and wheels that have a size and turn forward went through it so.
bool fits_together(const CalibrationState& state, const CalibrationQuality& quality, std::size_t lidar) {
  const bool are_wheels =
      std::ranges::all_of(state.wheels, [](double too_large) { return too_large > -1.0; });
  return quality.on_walls[lidar] > 0.5 && quality.way_off < kMostOff && are_wheels;
}

/// Whether what one lidar saw tells anything: enough walls, and a room that fits them.
struct Evidence {
  bool walls = false, fits = false;
};

Evidence evidence_of(const CalibrationState& state, const CalibrationQuality& quality, std::size_t lidar) {
  if (!quality.good || !are_enough(quality.walls[lidar])) return {};
  return {true, fits_together(state, quality, lidar)};
}

MountingLack lack_of(const FoundMounting& found, const MountingCalibration& all,
                     const CalibrationQuality& quality, const Evidence& evidence) {
  constexpr double kEnoughTurnRad = to_rad(120.0), kEnoughWayM = 0.8;
  if (found.sweeps < static_cast<int>(kFewestSweeps)) return MountingLack::Sweeps;
  if (!evidence.walls) return MountingLack::Walls;
  if (!evidence.fits) return MountingLack::Contradiction;
  if (found.known == MountingKnown::All)
    return quality.sizes_off < kMostOff ? MountingLack::Nothing : MountingLack::Wheels;
  if (all.driven_m < kEnoughWayM) return MountingLack::Straight;
  if (all.turned_rad < kEnoughTurnRad) return MountingLack::Turn;
  return MountingLack::Walls;
}

FoundMounting found_of(const CalibrationState& state, const CalibrationQuality& quality, std::size_t lidar,
                       const Evidence& evidence, const LidarModel& model, const LidarLook& look) {
  // What the model leaves out: beams that are not quite level, wheels that scrub.
  constexpr double kModelM = 0.002, kModelRad = to_rad(0.03);
  FoundMounting found;
  found.mounting = model.mounting;
  found.floor = look.floor;
  found.sweeps = static_cast<int>(look.sweeps.size());
  if (found.floor) found.mounting.z_m = found.floor->height_m;
  if (!quality.good || look.sweeps.size() < kFewestSweeps) return found;
  found.walls = static_cast<int>(quality.walls[lidar].size());
  found.residual_m = quality.residual_m[lidar];
  const auto sigma = quality.covariance[lidar].diagonal().cwiseMax(0.0).cwiseSqrt().eval();
  found.sigma = {std::hypot(sigma[0], kModelM), std::hypot(sigma[1], kModelM),
                 std::hypot(sigma[2], kModelRad)};
  if (!evidence.fits || !(found.sigma[2] < kYawKnownRad)) return found;
  found.known = MountingKnown::Yaw;
  found.mounting.yaw_rad = wrap_angle(state.base_from_lidar[lidar][2]);
  if (!(found.sigma[0] < kPlaceKnownM && found.sigma[1] < kPlaceKnownM)) return found;
  found.known = MountingKnown::All;
  found.mounting.x_m = state.base_from_lidar[lidar][0];
  found.mounting.y_m = state.base_from_lidar[lidar][1];
  return found;
}

/// How far the walls of one lidar lie beside those of another.
std::optional<LidarAgreement> agreement_of(const std::vector<RoomWall>& a, const std::vector<RoomWall>& b) {
  constexpr double kNearM = 0.15, kSameRad = to_rad(6.0), kAlongM = 0.8;
  std::vector<double> apart;
  for (const RoomWall& wall : a) {
    const double c = std::cos(wall.normal_rad), s = std::sin(wall.normal_rad);
    std::optional<double> best;
    for (const RoomWall& other : b) {
      const double dx = other.about.x_m - wall.about.x_m, dy = other.about.y_m - wall.about.y_m;
      if (std::hypot(dx, dy) > kAlongM || std::abs(wrap_angle(other.normal_rad - wall.normal_rad)) > kSameRad)
        continue;
      const double off = std::abs(c * dx + s * dy + other.offset_m - wall.offset_m);
      if (off < kNearM && (!best || off < *best)) best = off;
    }
    if (best) apart.push_back(*best);
  }
  if (apart.size() < static_cast<std::size_t>(kFewestWalls)) return std::nullopt;
  const auto count = static_cast<int>(apart.size());
  return LidarAgreement{0, 0, 1.4826 * median_of(apart), count};
}

/// Narrower gates as the poses get better.
CalibrationQuality refine(CalibrationState& state, const std::vector<LidarLook>& looks,
                          const std::vector<LidarModel>& lidars, const MountingDrive& drive,
                          const WheelGeometry& believed) {
  constexpr std::array<WallGates, 4> kGates{
      {{0.15, to_rad(8.0)}, {0.1, to_rad(6.0)}, {0.08, to_rad(6.0)}, {0.08, to_rad(6.0)}}};
  const WheelPath path(drive.wheels, believed);
  CalibrationQuality quality;
  for (std::size_t round = 0; round < kGates.size(); ++round) {
    if (round > 0) deskew_again(state, looks, lidars, WheelPath(drive.wheels, scaled(believed, state)));
    quality = solve_mounting(state, path, lidars, kGates[round]);
    if (!quality.good) break;
  }
  return quality;
}

}  // namespace

MountingCalibration calibrate_mounting(const MountingDrive& drive, const std::vector<LidarModel>& lidars,
                                       const WheelGeometry& believed) {
  const WheelPath path(drive.wheels, believed);
  std::vector<LidarLook> looks(lidars.size());
  CalibrationState state;
  state.base_from_lidar.resize(lidars.size());
  std::optional<Stamp> begun;
  for (std::size_t i = 0; i < lidars.size() && !path.empty(); ++i) {
    looks[i].sweeps = choose_sweeps(drive.sweeps, i, path);
    looks[i].floor = floor_of(looks[i].sweeps, lidars[i]);
    if (looks[i].sweeps.size() >= kFewestSweeps)
      begun = std::min(begun.value_or(Stamp::max()), end_of(*looks[i].sweeps.front()));
  }
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    const LidarMounting& m = lidars[i].mounting;
    state.base_from_lidar[i] = {m.x_m, m.y_m, m.yaw_rad};
    if (looks[i].sweeps.size() >= kFewestSweeps) begin_lidar(state, i, lidars[i], looks[i], path, *begun);
  }
  std::ranges::stable_sort(state.sweeps, {}, &CalibrationSweep::end);
  const CalibrationQuality quality = refine(state, looks, lidars, drive, believed);
  MountingCalibration result;
  result.turned_rad = path.turned_rad();
  result.driven_m = path.driven_m();
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    const Evidence evidence = evidence_of(state, quality, i);
    result.lidars.push_back(found_of(state, quality, i, evidence, lidars[i], looks[i]));
    result.lidars[i].lack = lack_of(result.lidars[i], result, quality, evidence);
    if (result.lidars[i].known == MountingKnown::Nothing) continue;
    const Eigen::Vector3d too_large(state.wheels[0], state.wheels[1], state.wheels[2]);
    result.wheels = FoundWheels{scaled(believed, state), too_large, quality.wheel_sigma};
  }
  for (std::size_t i = 0; quality.good && i < lidars.size(); ++i)
    for (std::size_t j = i + 1; j < lidars.size(); ++j)
      if (auto agreement = agreement_of(quality.walls[i], quality.walls[j])) {
        agreement->first = i, agreement->second = j;
        result.agreements.push_back(*agreement);
      }
  return result;
}

}  // namespace madori::localization
