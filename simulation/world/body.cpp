#include "simulation/world/body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace madori::simulation {
namespace {

struct Interval {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();

  /// Cuts by |start + t * step - middle| <= half.
  void clip(double start, double step, double half) {
    if (std::abs(step) < 1e-12) {
      if (std::abs(start) > half) leave = -1.0;
      return;
    }
    const double a = (-half - start) / step, b = (half - start) / step;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  /// Cuts by |(x, y) + t * (dx, dy)| <= radius.
  void clip_circle(double x, double y, double dx, double dy, double radius) {
    const double a = dx * dx + dy * dy, b = x * dx + y * dy, c = x * x + y * y - radius * radius;
    if (a < 1e-12) {
      if (c > 0.0) leave = -1.0;
      return;
    }
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) {
      leave = -1.0;
      return;
    }
    const double root = std::sqrt(discriminant);
    enter = std::max(enter, (-b - root) / a);
    leave = std::min(leave, (-b + root) / a);
  }
};

}  // namespace

double Body::reach_m() const {
  return round ? half_length_m : std::hypot(half_length_m, half_width_m);
}

float range_to(const Body& body, const Ray& ray) {
  Interval hit;
  const double middle = (body.z.low_m + body.z.high_m) / 2.0;
  hit.clip(ray.z_m - middle, ray.dz, (body.z.high_m - body.z.low_m) / 2.0);
  const double x = ray.x_m - body.centre.x_m, y = ray.y_m - body.centre.y_m;
  if (body.round) {
    hit.clip_circle(x, y, ray.dx, ray.dy, body.half_length_m);
  } else {
    const double c = std::cos(body.yaw_rad), s = std::sin(body.yaw_rad);
    hit.clip(c * x + s * y, c * ray.dx + s * ray.dy, body.half_length_m);
    hit.clip(c * y - s * x, c * ray.dy - s * ray.dx, body.half_width_m);
  }
  if (hit.leave < hit.enter || hit.enter <= 0.0) return Hit::kNothing;
  return static_cast<float>(hit.enter);
}

std::vector<Point2<Building>> outline(const Body& body) {
  std::vector<Point2<Building>> corners;
  if (body.round) {
    for (int i = 0; i < 16; ++i) {
      const double angle = kPi / 8.0 * i;
      corners.push_back({body.centre.x_m + body.half_length_m * std::cos(angle),
                         body.centre.y_m + body.half_length_m * std::sin(angle)});
    }
    return corners;
  }
  constexpr std::array<std::array<int, 2>, 4> kSigns{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const double c = std::cos(body.yaw_rad), s = std::sin(body.yaw_rad);
  for (const auto& [sx, sy] : kSigns) {
    const double u = sx * body.half_length_m, v = sy * body.half_width_m;
    corners.push_back({body.centre.x_m + c * u - s * v, body.centre.y_m + s * u + c * v});
  }
  return corners;
}

}  // namespace madori::simulation
