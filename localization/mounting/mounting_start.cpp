#include "localization/mounting/mounting_start.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>

namespace madori::localization {
namespace {

/// Row pairs of  R_yaw t_lidar - (R_vehicle - I) t_mounting = t_vehicle,  unknown x, y, cos yaw, sin yaw.
class MountingRows {
 public:
  explicit MountingRows(const LidarMounting& believed) {
    constexpr double kWeak = 1e-3;  // m: against metres of driving
    information_.diagonal().setConstant(kWeak);
    side_ = kWeak * Eigen::Vector4d(believed.x_m, believed.y_m, std::cos(believed.yaw_rad),
                                    std::sin(believed.yaw_rad));
  }
  void add(const Transform2<Lidar, Lidar>& lidar, const Transform2<Base, Base>& vehicle) {
    const double c = std::cos(lidar.yaw_rad()) - 1.0, s = std::sin(lidar.yaw_rad());
    Eigen::Matrix<double, 2, 4> rows;
    rows << -c, s, lidar.x_m(), -lidar.y_m(), -s, -c, lidar.y_m(), lidar.x_m();
    information_ += rows.transpose() * rows;
    side_ += rows.transpose() * Eigen::Vector2d(vehicle.x_m(), vehicle.y_m());
  }
  /// The yaw first, then the place with the yaw as it is: the two of sine and cosine have unit length.
  [[nodiscard]] Transform2<Base, Lidar> solve() const {
    const Eigen::Vector4d free = information_.ldlt().solve(side_);
    const double yaw = std::atan2(free[3], free[2]);
    const Eigen::Vector2d direction(std::cos(yaw), std::sin(yaw));
    const Eigen::Vector2d rest = side_.head<2>() - information_.topRightCorner<2, 2>() * direction;
    const Eigen::Vector2d place = information_.topLeftCorner<2, 2>().ldlt().solve(rest);
    return {place[0], place[1], yaw};
  }

 private:
  Eigen::Matrix4d information_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d side_ = Eigen::Vector4d::Zero();
};

}  // namespace

Transform2<Base, Lidar> closed_form_mounting(const std::vector<Transform2<Room, Lidar>>& lidar,
                                             const std::vector<Transform2<Odom, Base>>& vehicle,
                                             const LidarMounting& believed) {
  MountingRows rows(believed);
  // Long enough to tell something, short enough that the wheels have not drifted.
  for (const std::size_t apart : std::array<std::size_t, 3>{4, 8, 16})
    for (std::size_t i = 0; i + apart < lidar.size(); ++i)
      rows.add(lidar[i].inverse() * lidar[i + apart], vehicle[i].inverse() * vehicle[i + apart]);
  return rows.solve();
}

}  // namespace madori::localization
