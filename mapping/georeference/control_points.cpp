#include "mapping/georeference/control_points.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <optional>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/georeference/number_list.hpp"
#include "mapping/georeference/similarity_fit.hpp"

namespace madori::mapping {
namespace {

/// The few residuals of a small fit scatter widely, so noise is judged as if four more of one pixel had been
/// seen.
constexpr double kClickWeight = 4.0;
constexpr double kSmallestStretch = 0.002;
/// A fit must be this many times better than its rival to be believed.
constexpr double kClearly = 2.0;

Points2N without(const Points2N& points, Eigen::Index i) {
  Points2N rest(2, points.cols() - 1);
  rest << points.leftCols(i), points.rightCols(points.cols() - 1 - i);
  return rest;
}

double error_of(const Points2N& from, const Points2N& to) {
  const double sum = fit_similarity(from, to).residuals(from, to).squaredNorm();
  return from.cols() > 2 ? std::sqrt(sum / static_cast<double>(from.cols() - 2)) : 0.0;
}

Points2N flipped(const Points2N& from) {
  Points2N other = from;
  other.row(0) *= -1.0;
  return other;
}

std::optional<std::size_t> find_outlier(const Points2N& from, const Points2N& to, double m_per_px) {
  const double all = error_of(from, to);
  if (from.cols() < 4 || all < 3.0 * kClickPx * m_per_px) return std::nullopt;
  std::vector<double> rest;
  for (Eigen::Index i = 0; i < from.cols(); ++i) rest.push_back(error_of(without(from, i), without(to, i)));
  std::size_t best = 0;
  double second = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < rest.size(); ++i)
    if (rest[i] < rest[best]) best = i;
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (i != best) second = std::min(second, rest[i]);
  // Three points that remain have little to check each other with: all the more must the others contradict.
  const bool clear = rest[best] < all / 5.0 && rest[best] < second / 5.0;
  return clear ? std::optional(best) : std::nullopt;
}

void find_stretch(const Points2N& from, const Points2N& to, const Similarity& fit, ScaleEstimate& e) {
  if (from.cols() < 4) return;
  const StretchFit found = fit_stretch(from, to, fit);
  const double click = kClickPx * fit.scale;
  const auto freedom = static_cast<double>(2 * from.cols() - 5);
  const double noise =
      std::sqrt((kClickWeight * click * click + found.sum_of_squares) / (kClickWeight + freedom));
  if (!std::isfinite(found.stretch) || std::abs(found.stretch) < kSmallestStretch ||
      !(std::abs(found.stretch) > 3.0 * found.sigma * noise))
    return;
  e.stretch = found.stretch;
  e.outlier.reset();
  const std::string percent = fmt::format("{:.2f}", 100.0 * std::abs(found.stretch));
  e.notes.push_back(
      {"scale-stretched",
       {{"percent", percent}},
       fmt::format("the drawing is stretched: its scale along u is {} % {} than along v (photocopies do "
                   "this); scan it again, or live with half of that as an error",
                   percent, found.stretch > 0.0 ? "larger" : "smaller")});
}

/// Across the line that lies nearest to all of them they scatter no more than their clicks do.
bool lie_on_a_line(const Points2N& points) {
  const Points2N about = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix2d squares = about * about.transpose() / static_cast<double>(points.cols());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(squares).eigenvalues()[0] <
         std::pow(3.0 * kClickPx, 2);
}

/// What three points or more say of the drawing. Beside a line, clicks alone make any stretch.
void find_faults(const Points2N& from, const Points2N& to, const Similarity& fit, ScaleEstimate& e) {
  const bool line = lie_on_a_line(from);
  if (line)
    e.notes.push_back({"scale-on-a-line",
                       {},
                       "the points lie on one line, which shows neither a mirrored nor a stretched drawing; "
                       "give one far beside it"});
  e.mirrored = !line && kClearly * error_of(flipped(from), to) < error_of(from, to);
  if (e.mirrored) return;
  e.outlier = find_outlier(from, to, fit.scale);
  if (!line) find_stretch(from, to, fit, e);
}

/// The Map origin is the lower-left corner of the drawing's pixel grid, (u, v) = (0, height).
GeoreferenceRecord georeference_of(const Similarity& fit, const LocalPlane& plane, int height_px) {
  const Eigen::Vector2d origin = fit.apply({0.0, -static_cast<double>(height_px)});
  const LatLon place = plane.place_of({origin.x(), origin.y()});
  // North of the first point is not north of the origin: seen from there, the x axis is turned by a little.
  const Eigen::Vector2d along = fit.apply({1e3, -static_cast<double>(height_px)});
  const Point2<Enu> x_axis = LocalPlane(place).enu_of(plane.place_of({along.x(), along.y()}));
  return {place.latitude_deg, place.longitude_deg, to_deg(std::atan2(x_axis.y_m, x_axis.x_m))};
}

void fill_errors(const Points2N& from, const Points2N& to, const Similarity& fit, ScaleEstimate& e) {
  const Eigen::VectorXd residuals = fit.residuals(from, to);
  e.residuals_m.assign(residuals.begin(), residuals.end());
  e.error_m = error_of(from, to);
  for (Eigen::Index i = 0; from.cols() > 2 && i < from.cols(); ++i) {
    const Similarity others = fit_similarity(without(from, i), without(to, i));
    e.leave_one_out_m.push_back((others.apply(from.col(i)) - to.col(i)).norm());
  }
  const double spread = (from.colwise() - from.rowwise().mean()).norm() * fit.scale;
  const double click = kClickPx * fit.scale;
  // error^2 / 2 is the variance of one coordinate.
  e.relative_uncertainty = std::hypot(click, e.error_m / std::sqrt(2.0)) / spread;
}

}  // namespace

ControlPoint parse_control_point(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto pixel = parse_numbers(std::string_view(text).substr(0, equals));
  const auto place =
      equals == std::string::npos ? std::nullopt : parse_numbers(std::string_view(text).substr(equals + 1));
  if (!pixel || pixel->size() != 2 || !place || place->size() != 2)
    throw Error("--control " + text, "is not u,v=LAT,LON", "e.g. --control 120,80=35.464478,136.739235");
  const ControlPoint point{(*pixel)[0], (*pixel)[1], {(*place)[0], (*place)[1]}};
  (void)tile_of(point.place, 0);  // refuses what is no place
  return point;
}

void require_on_drawing(const std::vector<ControlPoint>& points, const DrawingRecord& drawing) {
  for (const auto& p : points)
    require_on_drawing(
        fmt::format("--control {:g},{:g}={:g},{:g}", p.u, p.v, p.place.latitude_deg, p.place.longitude_deg),
        p.u, p.v, drawing);
}

ScaleEstimate fit_control_points(const std::vector<ControlPoint>& points, int height_px) {
  if (points.size() < 2) throw Error("--control", "one point is not enough", "give two, better four or more");
  const LocalPlane plane(points.front().place);
  ScaleEstimate e;
  e.method = "control";
  Points2N from(2, points.size());
  Points2N to(2, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& p = points[i];
    const Point2<Enu> ground = plane.enu_of(p.place);
    from.col(static_cast<Eigen::Index>(i)) << p.u, -p.v;  // v goes down, y goes up
    to.col(static_cast<Eigen::Index>(i)) << ground.x_m, ground.y_m;
    e.inputs.push_back(fmt::format("{:.10g},{:.10g}={:.10g},{:.10g}", p.u, p.v, p.place.latitude_deg,
                                   p.place.longitude_deg));
  }
  if ((from.colwise() - from.rowwise().mean()).norm() < 1.0 ||
      (to.colwise() - to.rowwise().mean()).norm() < 1e-3)
    throw Error("--control", "all points are the same", "give points far apart");
  const Similarity fit = fit_similarity(from, to);
  e.m_per_px = fit.scale;
  e.verified = points.size() > 2;
  if (e.verified) find_faults(from, to, fit, e);
  fill_errors(from, to, fit, e);
  if (!e.mirrored) {
    e.georeference = georeference_of(fit, plane, height_px);
    const Eigen::Vector2d middle = from.rowwise().mean();
    e.held = {fit.scale * middle.x(), fit.scale * (height_px + middle.y())};
  }
  if (!e.verified)
    e.notes.push_back(
        {"scale-two-points", {}, "two points fit always: nothing verifies them; give a third and a fourth"});
  judge(e);
  return e;
}

}  // namespace madori::mapping
