#include "localization/self_calibration/surface_pieces.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

namespace madori::localization {
namespace {

constexpr double kSameWay = 0.94;  // cosine between the normals of neighbours on one surface

using Points = std::vector<SurfacePoint>;

bool goes_on(const Points& points, std::size_t first, std::size_t next, const Point2<Base>& sensor,
             const SurfacePieceOptions& options) {
  const SurfacePoint& p = points[next - 1];
  const SurfacePoint& q = points[next];
  const double range = std::hypot(q.x_m - sensor.x_m, q.y_m - sensor.y_m);
  const SurfacePoint& begin = points[first];
  return q.has_normal() && std::hypot(q.x_m - p.x_m, q.y_m - p.y_m) < options.gap_m + 0.05 * range &&
         begin.normal_x * q.normal_x + begin.normal_y * q.normal_y > kSameWay &&
         std::hypot(q.x_m - begin.x_m, q.y_m - begin.y_m) <= options.longest_m;
}

/// The line through points [first, last); nothing where they are too few or no line.
std::optional<SurfacePiece> line_through(const Points& points, std::size_t first, std::size_t last,
                                         const SurfacePieceOptions& options) {
  const auto n = static_cast<double>(last - first);
  if (n < options.fewest_points) return std::nullopt;
  SurfacePiece piece;
  for (std::size_t i = first; i < last; ++i) {
    piece.centre.x_m += points[i].x_m / n;
    piece.centre.y_m += points[i].y_m / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const double dx = points[i].x_m - piece.centre.x_m;
    const double dy = points[i].y_m - piece.centre.y_m;
    xx += dx * dx / n;
    xy += dx * dy / n;
    yy += dy * dy / n;
  }
  const double least = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
  piece.length_m =
      std::hypot(points[last - 1].x_m - points[first].x_m, points[last - 1].y_m - points[first].y_m);
  if (piece.length_m < options.shortest_m || least > options.most_rms_m * options.most_rms_m)
    return std::nullopt;
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const double facing =
      -std::sin(direction) * points[first].normal_x + std::cos(direction) * points[first].normal_y;
  const double sign = facing < 0.0 ? -1.0 : 1.0;
  piece.normal_x = -sign * std::sin(direction);
  piece.normal_y = sign * std::cos(direction);
  return piece;
}

}  // namespace

std::vector<SurfacePiece> surface_pieces(const SurfaceScan& scan, const SurfacePieceOptions& options) {
  std::vector<SurfacePiece> pieces;
  for (std::size_t first = 0; first < scan.points.size();) {
    std::size_t last = first + 1;
    if (scan.points[first].has_normal()) {
      while (last < scan.points.size() && goes_on(scan.points, first, last, scan.sensor, options)) ++last;
      if (const auto piece = line_through(scan.points, first, last, options)) pieces.push_back(*piece);
    }
    first = last;
  }
  return pieces;
}

}  // namespace madori::localization
