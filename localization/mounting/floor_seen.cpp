#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/angle.hpp"
#include "localization/mounting/wall_pieces.hpp"

namespace madori::localization {
namespace {

constexpr std::size_t kMostPoints = 1500;
constexpr int kTries = 150;
constexpr double kReachM = 10.0;   // farther out a degree of tilt is more than the lasers' spacing shows
constexpr double kOwnBodyM = 0.5;  // nearer returns are of the vehicle
constexpr double kBandM = 0.06;    // around a plane: the noise of a return
constexpr double kLeastHeightM = 0.05;
constexpr double kMostHeightM = 5.0;
constexpr double kSteepest = 0.21;    // 12 degrees
constexpr double kLeastShare = 0.35;  // of the returns that look down
constexpr double kMostBelow = 0.08;   // of them: below a floor there is nothing but reflections
constexpr int kSectors = 16;
constexpr int kLeastSectors = 4;

using Points = std::vector<Eigen::Vector3d>;

/// Evenly chosen returns of the lasers that look down.
Points looking_down(const PointCloud<Lidar>& cloud) {
  constexpr double kLeastSlope = 0.04;
  Points all;
  all.reserve(cloud.points.size());
  for (const CloudPoint& p : cloud.points) {
    const Eigen::Vector3d at = Eigen::Vector3f(p.x_m, p.y_m, p.z_m).cast<double>();
    const double range = at.head<2>().norm();
    if (at.allFinite() && range > kOwnBodyM && range < kReachM && at.z() < -kLeastSlope * range)
      all.push_back(at);
  }
  const std::size_t kept = std::min(all.size(), kMostPoints);
  for (std::size_t i = 0; i < kept; ++i) all[i] = all[i * all.size() / kept];
  all.resize(kept);
  return all;
}

double above(const FloorSeen& plane, const Eigen::Vector3d& p) {
  return p.z() + plane.height_m - plane.slope_x * p.x() - plane.slope_y * p.y();
}

bool is_possible(const FloorSeen& plane) {
  return plane.height_m > kLeastHeightM && plane.height_m < kMostHeightM &&
         std::hypot(plane.slope_x, plane.slope_y) < kSteepest;
}

std::optional<FloorSeen> through(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (!(std::abs(normal.z()) > 1e-3)) return std::nullopt;
  FloorSeen plane;
  plane.slope_x = -normal.x() / normal.z();
  plane.slope_y = -normal.y() / normal.z();
  plane.height_m = plane.slope_x * a.x() + plane.slope_y * a.y() - a.z();
  return is_possible(plane) ? std::optional(plane) : std::nullopt;
}

int count_near(const Points& points, const FloorSeen& plane, double band_m) {
  return static_cast<int>(
      std::ranges::count_if(points, [&](const auto& p) { return std::abs(above(plane, p)) < band_m; }));
}

/// Least squares over what lies within the band.
std::optional<FloorSeen> refit(const Points& points, const FloorSeen& plane, double band_m) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  FloorSeen fit;
  double sum = 0.0;
  for (const auto& p : points) {
    const double off = above(plane, p);
    if (!(std::abs(off) < band_m)) continue;
    const Eigen::Vector3d row(1.0, p.x(), p.y());
    squares += row * row.transpose();
    side += row * p.z();
    sum += off * off;
    ++fit.points;
  }
  if (fit.points < 30 || !(squares.determinant() > 1e-6)) return std::nullopt;
  const Eigen::Matrix3d inverse = squares.inverse();
  const Eigen::Vector3d found = inverse * side;
  fit.height_m = -found[0];
  fit.slope_x = found[1];
  fit.slope_y = found[2];
  fit.sigma_m = std::sqrt(sum / fit.points * inverse(0, 0));
  return is_possible(fit) ? std::optional(fit) : std::nullopt;
}

/// A table top or a ramp is no floor: that goes all around, and nothing lies below it.
bool is_floor(const Points& points, const FloorSeen& plane) {
  std::array<bool, kSectors> seen{};
  int below = 0;
  for (const auto& p : points) {
    const double off = above(plane, p);
    below += off < -2.0 * kBandM ? 1 : 0;
    if (std::abs(off) > kBandM) continue;
    const double turn = (std::atan2(p.y(), p.x()) + kPi) / (2.0 * kPi);
    seen[std::min(static_cast<std::size_t>(turn * kSectors), seen.size() - 1)] = true;
  }
  const auto count = static_cast<double>(points.size());
  return plane.points > kLeastShare * count && below < kMostBelow * count &&
         std::ranges::count(seen, true) >= kLeastSectors;
}

}  // namespace

double FloorSeen::tilt_rad() const {
  return std::atan(std::hypot(slope_x, slope_y));
}

std::optional<FloorSeen> find_floor(const PointCloud<Lidar>& cloud, const LidarModel& lidar) {
  if (lidar.kind != LidarKind::Spinning) return std::nullopt;
  const Points points = looking_down(cloud);
  if (points.size() < 60) return std::nullopt;
  std::minstd_rand random(1);
  std::uniform_int_distribution<std::size_t> any(0, points.size() - 1);
  std::optional<FloorSeen> best;
  for (int i = 0; i < kTries; ++i) {
    auto plane = through(points[any(random)], points[any(random)], points[any(random)]);
    if (!plane) continue;
    plane->points = count_near(points, *plane, kBandM);
    if (!best || plane->points > best->points) best = plane;
  }
  for (const double band_m : {2.0 * kBandM, kBandM, kBandM})
    if (best) best = refit(points, *best, band_m);
  return best && is_floor(points, *best) ? best : std::nullopt;
}

}  // namespace madori::localization
