#include "localization/mounting/room_walls.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

constexpr double kAlongM = 0.8;  // a piece is at most 1 m long: farther along it is another part of the wall

double distance_beside(const RoomWall& wall, const Point2<Room>& p) {
  return std::cos(wall.normal_rad) * (p.x_m - wall.about.x_m) +
         std::sin(wall.normal_rad) * (p.y_m - wall.about.y_m) - wall.offset_m;
}

double normal_in_room(const WallPiece& piece, const Transform2<Room, Lidar>& pose) {
  return pose.yaw_rad() + std::atan2(piece.normal_y, piece.normal_x);
}

/// One step of Gauss-Newton for the pose of a sweep among the walls; `guess` holds it with its own sigmas.
Transform2<Room, Lidar> step_pose(const RoomWalls& room, const std::vector<WallPiece>& pieces,
                                  const Transform2<Room, Lidar>& pose, const Transform2<Room, Lidar>& guess,
                                  const Eigen::Vector3d& guess_sigma, const WallGates& gates,
                                  const LidarModel& lidar) {
  Eigen::Matrix3d information = guess_sigma.cwiseProduct(guess_sigma).cwiseInverse().asDiagonal();
  Eigen::Vector3d side = -information * pose_difference(pose, guess);
  for (const WallPiece& piece : pieces) {
    const auto found = room.find(piece, pose, gates);
    if (!found) continue;
    const RoomWall& wall = room.walls()[*found];
    const double weight = piece_weight(piece, lidar);
    const double c = std::cos(wall.normal_rad), s = std::sin(wall.normal_rad);
    for (const double along_m : {-piece.spread_m, piece.spread_m}) {
      const Point2<Lidar> p{piece.centre.x_m - along_m * piece.normal_y,
                            piece.centre.y_m + along_m * piece.normal_x};
      const Point2<Room> q = pose * p;
      const double residual = distance_beside(wall, q);
      const double dx = q.x_m - pose.x_m(), dy = q.y_m - pose.y_m();
      const Eigen::Vector3d row(c, s, -c * dy + s * dx);
      const double loss = 1.0 / (1.0 + residual * residual / (0.25 * gates.beside_m * gates.beside_m));
      information += 0.5 * weight * loss * row * row.transpose();
      side -= 0.5 * weight * loss * residual * row;
    }
  }
  const Eigen::Vector3d step = information.ldlt().solve(side);
  return {pose.x_m() + step[0], pose.y_m() + step[1], pose.yaw_rad() + step[2]};
}

}  // namespace

std::optional<std::size_t> RoomWalls::find(const WallPiece& piece, const Transform2<Room, Lidar>& pose,
                                           const WallGates& gates) const {
  const Point2<Room> at = pose * piece.centre;
  const double normal_rad = normal_in_room(piece, pose);
  std::optional<std::size_t> best;
  double nearest = 1.0;
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    const RoomWall& wall = walls_[i];
    const double dx = at.x_m - wall.about.x_m, dy = at.y_m - wall.about.y_m;
    if (dx * dx + dy * dy > kAlongM * kAlongM + gates.beside_m * gates.beside_m) continue;
    const double turned = std::abs(wrap_angle(normal_rad - wall.normal_rad));
    const double beside = std::abs(distance_beside(wall, at));
    if (turned > gates.turned_rad || beside > gates.beside_m) continue;
    const double far = 0.5 * beside / gates.beside_m + 0.5 * std::hypot(dx, dy) / (kAlongM + gates.beside_m);
    if (far < nearest) nearest = far, best = i;
  }
  return best;
}

std::size_t RoomWalls::add(const WallPiece& piece, const Transform2<Room, Lidar>& pose,
                           const WallGates& gates, std::size_t sweep) {
  if (const auto found = find(piece, pose, gates)) {
    RoomWall& wall = walls_[*found];
    wall.sightings += wall.last_sweep == sweep ? 0 : 1;
    wall.last_sweep = sweep;
    return *found;
  }
  walls_.push_back({pose * piece.centre, normal_in_room(piece, pose), 0.0, 1, sweep});
  return walls_.size() - 1;
}

double piece_weight(const WallPiece& piece, const LidarModel& lidar) {
  constexpr double kUnevenM = 0.006;
  return 1.0 / (lidar.sigma_m * lidar.sigma_m / piece.points + kUnevenM * kUnevenM);
}

std::vector<Transform2<Room, Lidar>> track_lidar(const std::vector<std::vector<WallPiece>>& sweeps,
                                                 const std::vector<double>& turned_rad,
                                                 const LidarModel& lidar) {
  constexpr WallGates kJoin{0.08, to_rad(8.0)};
  constexpr std::array<WallGates, 6> kNarrowing{{{0.35, to_rad(12.0)},
                                                 {0.25, to_rad(10.0)},
                                                 {0.15, to_rad(10.0)},
                                                 {0.1, to_rad(8.0)},
                                                 {0.08, to_rad(8.0)},
                                                 {0.08, to_rad(8.0)}}};
  std::vector<Transform2<Room, Lidar>> poses;
  RoomWalls room;
  Transform2<Lidar, Lidar> before;  // the last motion between two sweeps: it may go on like that
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    Transform2<Room, Lidar> pose;
    if (k > 0) {
      const double turn = turned_rad[k] - turned_rad[k - 1];
      const Transform2<Room, Lidar> guess =
          poses.back() * Transform2<Lidar, Lidar>(before.x_m(), before.y_m(), turn);
      const Eigen::Vector3d sigma(0.15, 0.15, 0.01 + 0.05 * std::abs(turn));
      pose = guess;
      for (const WallGates& gates : kNarrowing)
        pose = step_pose(room, sweeps[k], pose, guess, sigma, gates, lidar);
      before = Transform2<Lidar, Room>(poses.back().inverse()) * pose;
    }
    for (const WallPiece& piece : sweeps[k]) room.add(piece, pose, kJoin, k);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace madori::localization
