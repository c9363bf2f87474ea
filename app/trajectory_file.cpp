#include "app/trajectory_file.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "app/number_table.hpp"
#include "core/result.hpp"

namespace madori::app {

std::string tum_line(Stamp stamp, const Transform2<Map, Base>& map_from_base) {
  const double half = 0.5 * map_from_base.yaw_rad();
  std::array<char, 160> line{};
  const long long microseconds = stamp.time_since_epoch().count() / 1'000;
  const long long size = std::llabs(microseconds);  // a remainder has a sign of its own
  std::snprintf(line.data(), line.size(), "%s%lld.%06lld %.6f %.6f 0 0 0 %.9f %.9f\n",
                microseconds < 0 ? "-" : "", size / 1'000'000, size % 1'000'000, map_from_base.x_m(),
                map_from_base.y_m(), std::sin(half), std::cos(half));
  return line.data();
}

std::vector<StampedPose> load_tum(const std::filesystem::path& file) {
  std::vector<StampedPose> poses;
  for (const NumberRow& row : load_number_table(file, 8)) {
    const auto& v = row.values;
    if (std::abs(std::hypot(std::hypot(v[4], v[5]), std::hypot(v[6], v[7])) - 1.0) > 0.01) {
      throw Error(file.string() + ":" + std::to_string(row.line), "the quaternion is not of unit length",
                  "the columns are: timestamp x y z qx qy qz qw");
    }
    const double yaw = std::atan2(2.0 * (v[7] * v[6] + v[4] * v[5]), 1.0 - 2.0 * (v[5] * v[5] + v[6] * v[6]));
    poses.push_back({stamp_from_seconds(v[0]), {v[1], v[2], yaw}});
  }
  return poses;
}

}  // namespace madori::app
