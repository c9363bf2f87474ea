#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "core/angle.hpp"
#include "core/frames.hpp"
#include "core/point_cloud.hpp"
#include "core/transform2.hpp"
#include "planning/obstacle_check/sight_history.hpp"

namespace madori::test {

/// An upright cylinder standing on the floor of the Map frame, or hanging from `bottom_m`.
struct Post {
  Point2<Map> at;
  double radius_m = 0.035;
  double top_m = 0.4;
  double bottom_m = 0.0;
};

/// A body lying on the floor: a box with a centre line and half width; its round top counts as flat.
struct LyingBody {
  Segment2<Map> axis;
  double half_width_m = 0.1;
  double top_m = 0.2;

  [[nodiscard]] std::array<Segment2<Map>, 4> edges() const {
    const double length = axis.length_m();
    const double nx = -(axis.b.y_m - axis.a.y_m) / length * half_width_m;
    const double ny = (axis.b.x_m - axis.a.x_m) / length * half_width_m;
    const Point2<Map> a{axis.a.x_m + nx, axis.a.y_m + ny};
    const Point2<Map> b{axis.b.x_m + nx, axis.b.y_m + ny};
    const Point2<Map> c{axis.b.x_m - nx, axis.b.y_m - ny};
    const Point2<Map> d{axis.a.x_m - nx, axis.a.y_m - ny};
    return {{{a, b}, {b, c}, {c, d}, {d, a}}};
  }
};

/// What a lidar of 16 beams sees above the Base origin.
inline constexpr planning::SensorView kVlp{0.0, 0.0, 0.9, to_rad(-15.0), to_rad(15.0)};

/// A flat floor and a few bodies, seen by 16 beams of a lidar above the Base origin. For tests of planning
/// and control alone; the virtual factory has the real one.
class ToyLidar {
 public:
  double height_m = 0.9;
  double noise_m = 0.01;
  int azimuths = 900;
  std::vector<Post> posts;
  std::vector<LyingBody> bodies;

  [[nodiscard]] PointCloud<Base> scan(const Transform2<Map, Base>& pose, Stamp stamp,
                                      std::mt19937& random) const {
    std::normal_distribution<double> noise(0.0, noise_m);
    PointCloud<Base> cloud{stamp, {}};
    for (int i = 0; i < azimuths; ++i) {
      const double azimuth = 2.0 * kPi * i / azimuths;
      for (int ring = 0; ring < 16; ++ring) {
        const double elevation = to_rad(-15.0 + 2.0 * ring);
        const auto hit = cast(pose, azimuth, std::tan(elevation));
        if (!hit) continue;
        const double flat = std::max(0.0, *hit + noise(random) * std::cos(elevation));
        cloud.points.push_back({static_cast<float>(flat * std::cos(azimuth)),
                                static_cast<float>(flat * std::sin(azimuth)),
                                static_cast<float>(height_m + flat * std::tan(elevation)), 0.0F, 50,
                                static_cast<std::uint8_t>(ring)});
      }
    }
    return cloud;
  }

 private:
  /// The horizontal distance at which a beam ends, within 30 m.
  [[nodiscard]] std::optional<double> cast(const Transform2<Map, Base>& pose, double azimuth,
                                           double slope) const {
    const double cosine = std::cos(azimuth + pose.yaw_rad());
    const double sine = std::sin(azimuth + pose.yaw_rad());
    double nearest = slope < 0.0 ? height_m / -slope : std::numeric_limits<double>::infinity();
    const auto consider = [&](double flat, double low, double high) {
      const double z = height_m + flat * slope;
      if (flat > 0.0 && flat < nearest && z >= low && z <= high) nearest = flat;
    };
    for (const Post& post : posts) {
      const double dx = post.at.x_m - pose.x_m();
      const double dy = post.at.y_m - pose.y_m();
      const double along = dx * cosine + dy * sine;
      const double aside = dx * sine - dy * cosine;
      if (along <= 0.0 || std::abs(aside) > post.radius_m) continue;
      consider(along - std::sqrt(post.radius_m * post.radius_m - aside * aside), post.bottom_m, post.top_m);
    }
    for (const LyingBody& body : bodies) enter(body, pose, cosine, sine, slope, consider);
    if (nearest > 30.0) return std::nullopt;
    return nearest;
  }

  template <class Consider>
  void enter(const LyingBody& body, const Transform2<Map, Base>& pose, double cosine, double sine,
             double slope, Consider&& consider) const {
    const double length = body.axis.length_m();
    const double ux = (body.axis.b.x_m - body.axis.a.x_m) / length;
    const double uy = (body.axis.b.y_m - body.axis.a.y_m) / length;
    const double ox = pose.x_m() - body.axis.a.x_m;
    const double oy = pose.y_m() - body.axis.a.y_m;
    const double px = ox * ux + oy * uy;
    const double py = -ox * uy + oy * ux;
    const double dx = cosine * ux + sine * uy;
    const double dy = -cosine * uy + sine * ux;
    double enter_m = 0.0;
    double leave_m = 1e9;
    const auto slab = [&](double origin, double direction, double low, double high) {
      if (std::abs(direction) < 1e-12) {
        if (origin < low || origin > high) leave_m = -1.0;
        return;
      }
      const auto [a, b] = std::minmax({(low - origin) / direction, (high - origin) / direction});
      enter_m = std::max(enter_m, a);
      leave_m = std::min(leave_m, b);
    };
    slab(px, dx, 0.0, length);
    slab(py, dy, -body.half_width_m, body.half_width_m);
    if (enter_m >= leave_m || enter_m <= 0.0) return;
    consider(enter_m, 0.0, body.top_m);
    if (slope < 0.0) {  // down onto the top
      const double top = (body.top_m - height_m) / slope;
      if (top > enter_m && top < leave_m) consider(top, 0.0, body.top_m + 1e-6);
    }
  }
};

}  // namespace madori::test
