#include "localization/self_calibration/strain_row.hpp"

#include <cmath>

#include "localization/drawing_fit/wall_hits.hpp"

namespace madori::localization {
namespace {

constexpr double kParallelCosine = 0.97;

}  // namespace

Point2<Map> StrainAbout::drawn(const Point2<Map>& p) const {
  const double x = p.x_m - middle.x_m;
  const double y = p.y_m - middle.y_m;
  return {p.x_m + strain[0] * x + 0.5 * strain[2] * y, p.y_m + strain[1] * y + 0.5 * strain[2] * x};
}

std::optional<StrainRow> strain_row(const WallIndex& drawing, const StrainAbout& strained,
                                    const Transform2<Map, Base>& pose, const SurfacePiece& piece,
                                    double beside_m) {
  const Point2<Map> p = pose * piece.centre;
  const double nx = pose.cos_yaw() * piece.normal_x - pose.sin_yaw() * piece.normal_y;
  const double ny = pose.sin_yaw() * piece.normal_x + pose.cos_yaw() * piece.normal_y;
  const Point2<Map> q = strained.drawn(p);
  const auto hit = drawing.nearest(q.x_m, q.y_m, WallIndex::direction_of(nx, ny));
  if (hit.wall < 0 || hit.beyond_m > kBeyondM || std::abs(hit.distance_m) > beside_m ||
      std::abs(nx * hit.normal_x + ny * hit.normal_y) < kParallelCosine)
    return std::nullopt;
  const Eigen::Vector3d& s = strained.strain;
  StrainRow row;
  row.wall = hit.wall;
  row.residual_m = hit.distance_m;
  const double mx = (1.0 + s[0]) * hit.normal_x + 0.5 * s[2] * hit.normal_y;
  const double my = (1.0 + s[1]) * hit.normal_y + 0.5 * s[2] * hit.normal_x;
  row.by_pose = {mx, my, -mx * (p.y_m - pose.y_m()) + my * (p.x_m - pose.x_m())};
  const double x = p.x_m - strained.middle.x_m;
  const double y = p.y_m - strained.middle.y_m;
  row.by_strain = {hit.normal_x * x, hit.normal_y * y, 0.5 * (hit.normal_x * y + hit.normal_y * x)};
  return row;
}

double geman_mcclure(double residual, double scale) {
  const double ratio = scale * scale / (scale * scale + residual * residual);
  return ratio * ratio;
}

}  // namespace madori::localization
