#include "localization/warp/drawing_warp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/warp/cubic_basis.hpp"

namespace madori::localization {
namespace {

/// Farther than this many spacings beyond the lattice no control point reaches; keeps the indices small.
constexpr double kReach = 4.0;

bool is_near(const WarpField& field, double u, double v) {
  return u > -kReach && v > -kReach && u < field.width + kReach && v < field.height + kReach;
}

/// Calls visit(control point, weight, slope along x, slope along y), slopes by metre.
template <class Visit>
void for_each_control(const WarpField& field, const Point2<Map>& p, Visit&& visit) {
  const double u = (p.x_m - field.origin.x_m) / field.spacing_m;
  const double v = (p.y_m - field.origin.y_m) / field.spacing_m;
  if (!is_near(field, u, v)) return;
  visit_controls(field.width, field.height, u, v,
                 [&](int control, double weight, double slope_u, double slope_v) {
                   visit(static_cast<std::size_t>(control), weight, slope_u / field.spacing_m,
                         slope_v / field.spacing_m);
                 });
}

}  // namespace

/// A place carried to the building, and d(building) / d(map) there: [xx xy; yx yy].
struct DrawingWarp::Local {
  Point2<Building> place;
  double xx;
  double xy;
  double yx;
  double yy;
};

DrawingWarp::DrawingWarp(const WarpSimilarity& similarity, WarpField field,
                         const WarpStatistics& statistics) {
  const bool identity =
      similarity == WarpSimilarity{} &&
      std::all_of(field.control_m.begin(), field.control_m.end(), [](double c) { return c == 0.0; });
  data_ = std::make_shared<const Data>(Data{similarity, std::move(field), statistics, identity});
}

const DrawingWarp::Data& DrawingWarp::data() const {
  static const Data none;
  return data_ ? *data_ : none;
}

DrawingWarp::Local DrawingWarp::local(const Point2<Map>& p) const {
  const WarpSimilarity& s = data().similarity;
  const double c = s.scale * std::cos(s.yaw_rad);
  const double d = s.scale * std::sin(s.yaw_rad);
  Local at{{c * p.x_m - d * p.y_m + s.x_m, d * p.x_m + c * p.y_m + s.y_m}, c, -d, d, c};
  for_each_control(data().field, p, [&](std::size_t k, double weight, double slope_x, double slope_y) {
    const double* control = &data().field.control_m[2 * k];
    at.place.x_m += weight * control[0];
    at.place.y_m += weight * control[1];
    at.xx += slope_x * control[0];
    at.xy += slope_y * control[0];
    at.yx += slope_x * control[1];
    at.yy += slope_y * control[1];
  });
  return at;
}

Point2<Building> DrawingWarp::building(const Point2<Map>& p) const {
  if (is_identity()) return {p.x_m, p.y_m};
  return local(p).place;
}

Point2<Map> DrawingWarp::map(const Point2<Building>& p) const {
  if (is_identity()) return {p.x_m, p.y_m};
  constexpr int kMostSteps = 20;
  constexpr double kEnoughM = 1e-6;
  const WarpSimilarity& s = similarity();
  const double c = std::cos(s.yaw_rad) / s.scale;
  const double d = std::sin(s.yaw_rad) / s.scale;
  const double dx = p.x_m - s.x_m;
  const double dy = p.y_m - s.y_m;
  Point2<Map> q{c * dx + d * dy, -d * dx + c * dy};
  for (int step = 0; step < kMostSteps; ++step) {
    const Local at = local(q);
    const double ex = p.x_m - at.place.x_m;
    const double ey = p.y_m - at.place.y_m;
    if (std::abs(ex) + std::abs(ey) < kEnoughM) break;
    const double det = std::max(0.1, at.xx * at.yy - at.xy * at.yx);
    q.x_m += (at.yy * ex - at.xy * ey) / det;
    q.y_m += (at.xx * ey - at.yx * ex) / det;
  }
  return q;
}

double DrawingWarp::turn_rad(const Point2<Map>& p) const {
  if (is_identity()) return 0.0;
  const Local at = local(p);
  return std::atan2(at.yx - at.xy, at.xx + at.yy);
}

Transform2<Building, Base> DrawingWarp::building(const Transform2<Map, Base>& pose) const {
  const Point2<Building> at = building(pose.translation());
  return {at.x_m, at.y_m, pose.yaw_rad() + turn_rad(pose.translation())};
}

Transform2<Map, Base> DrawingWarp::map(const Transform2<Building, Base>& pose) const {
  const Point2<Map> at = map(pose.translation());
  return {at.x_m, at.y_m, pose.yaw_rad() - turn_rad(at)};
}

double steepest_step_m(const WarpField& field) {
  const auto step = [&](int a, int b) {
    const auto i = static_cast<std::size_t>(2 * a), k = static_cast<std::size_t>(2 * b);
    return std::hypot(field.control_m[i] - field.control_m[k],
                      field.control_m[i + 1] - field.control_m[k + 1]);
  };
  double steepest = 0.0;
  for (int p = 0; p < field.width * field.height; ++p) {
    if (p % field.width > 0) steepest = std::max(steepest, step(p, p - 1));
    if (p >= field.width) steepest = std::max(steepest, step(p, p - field.width));
  }
  return steepest;
}

double DrawingWarp::sigma_m(const Point2<Map>& p) const {
  if (!data_) return 0.0;
  const double far_m = data().statistics.amplitude_m;
  if (data().field.sigma_m.empty()) return far_m;
  double beside = 1.0;
  double variance = 0.0;
  for_each_control(data().field, p, [&](std::size_t k, double weight, double, double) {
    variance += weight * data().field.sigma_m[k] * data().field.sigma_m[k];
    beside -= weight;
  });
  return std::sqrt(variance + std::max(0.0, beside) * far_m * far_m);
}

}  // namespace madori::localization
