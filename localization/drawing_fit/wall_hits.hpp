#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"

namespace madori::localization {

/// Errors of a drawing persist along a wall: its pieces within two metres are one observation, of which a
/// surface of the cloud is this share.
inline constexpr double kShareOfObservation = kVoxelM / 2.0;
/// What an observation, and a nat of the likelihood of all, is worth: rooms and aisles repeat, and so do the
/// errors of a drawing.
inline constexpr double kTrust = 0.4;
inline constexpr double kBeyondM = 0.3;  ///< a surface may overshoot a drawn wall's end by this

/// Score of a surface by its distance to a wall, WallIndex::centimetres; 255, no wall at all, is none.
[[nodiscard]] inline std::array<float, 256> scores_by_centimetre(float blur_cm) {
  std::array<float, 256> scores{};
  for (std::size_t i = 0; i < 255; ++i) {
    const float z = static_cast<float>(i) / blur_cm;
    scores[i] = std::exp(-0.5F * z * z);
  }
  return scores;
}

/// Of the surface's normal after the correction, as WallIndex::direction_of.
[[nodiscard]] inline int turned_direction(const CloudSurface& p, const Transform2<Map, Map>& by) {
  return WallIndex::direction_of(by.cos_yaw() * p.normal_x - by.sin_yaw() * p.normal_y,
                                 by.sin_yaw() * p.normal_x + by.cos_yaw() * p.normal_y);
}

/// Calls visit(surface, place after the correction, hit) for each surface that has a wall to belong to.
template <class Visit>
void for_each_hit(const WallIndex& index, const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                  Visit&& visit) {
  for (const CloudSurface& p : cloud) {
    const Point2<Map> q = correction * Point2<Map>{p.x_m, p.y_m};
    const WallIndex::Hit hit = index.nearest(q.x_m, q.y_m, turned_direction(p, correction));
    if (hit.wall >= 0 && hit.beyond_m <= kBeyondM) {
      visit(p, q, hit);
    }
  }
}

/// Calls visit(place, hit, length) for each directed point of a scan; the length is of its surface, metres, a
/// voxel at most; `hit.wall` is -1 where none is near.
template <class Visit>
void for_each_surface(const WallIndex& index, const SurfaceScan& scan, const Transform2<Map, Base>& pose,
                      Visit&& visit) {
  for (std::size_t i = 1; i < scan.points.size(); ++i) {
    const SurfacePoint& p = scan.points[i];
    if (!p.has_normal()) continue;
    const SurfacePoint q = moved(pose, p);
    WallIndex::Hit hit = index.nearest(q.x_m, q.y_m, WallIndex::direction_of(q.normal_x, q.normal_y));
    if (hit.beyond_m > kBeyondM) hit.wall = -1;
    const double gap = std::hypot(p.x_m - scan.points[i - 1].x_m, p.y_m - scan.points[i - 1].y_m);
    visit(Point2<Map>{q.x_m, q.y_m}, hit, std::min(kVoxelM, gap));
  }
}

/// Of the signed distance between `q` and the wall's line, by a motion (dx, dy, turn about pivot), Map axes.
[[nodiscard]] inline Eigen::Vector3d jacobian(const WallIndex::Hit& hit, const Point2<Map>& q,
                                              const Point2<Map>& pivot) {
  return {hit.normal_x, hit.normal_y,
          -hit.normal_x * (q.y_m - pivot.y_m) + hit.normal_y * (q.x_m - pivot.x_m)};
}

}  // namespace madori::localization
