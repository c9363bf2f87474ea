#include "control/pure_pursuit/tracked_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/segment_distance.hpp"

namespace madori::control {
namespace {

constexpr double kSamePointM = 1e-6;
constexpr double kSearchAheadM = 2.0;

}  // namespace

double SpeedLimits::speed_to_stop_within(double distance_m) const {
  if (!(distance_m > 0.0)) return 0.0;
  const double lost = deceleration_mps2 * reaction_s;  // d = v t + v^2 / 2a
  return std::sqrt(lost * lost + 2.0 * deceleration_mps2 * distance_m) - lost;
}

double SpeedLimits::speed_on_curve(double curvature_per_m) const {
  const double curvature = std::max(std::abs(curvature_per_m), 1e-6);
  return std::min(std::sqrt(lateral_acceleration_mps2 / curvature), max_turn_rate_radps / curvature);
}

TrackedPath::TrackedPath(Path path, const SpeedLimits& limits) : path_(std::move(path)) {
  find_pieces();
  make_speed_profile(limits);
}

void TrackedPath::find_pieces() {
  const auto& points = path_.points;
  along_m_.reserve(points.size());
  std::size_t first = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double step_m = i == 0 ? 0.0 : distance_m(points[i - 1].position, points[i].position);
    along_m_.push_back(i == 0 ? 0.0 : along_m_.back() + step_m);
    if (i > 0 && step_m < kSamePointM) {
      pieces_.push_back({first, i});
      first = i;
    }
  }
  if (!points.empty()) pieces_.push_back({first, points.size()});
}

void TrackedPath::make_speed_profile(const SpeedLimits& limits) {
  speed_mps_.assign(path_.points.size(), 0.0);
  for (const PathPiece& piece : pieces_) {
    for (std::size_t i = piece.end - 1; i-- > piece.first;) {
      const PathPoint& point = path_.points[i];
      const double step_m = along_m_[i + 1] - along_m_[i];
      const double next = speed_mps_[i + 1];
      const double braking = std::sqrt(next * next + 2.0 * limits.deceleration_mps2 * step_m);
      const double to_end = limits.speed_to_stop_within(along_m_[piece.end - 1] - along_m_[i]);
      speed_mps_[i] = std::min({limits.max_speed_mps, point.speed_limit_mps, braking, to_end,
                                limits.speed_on_curve(point.curvature_per_m)});
    }
  }
}

double TrackedPath::speed_at(const PathPiece& piece, double along_m) const {
  const auto begin = along_m_.begin() + static_cast<std::ptrdiff_t>(piece.first);
  const auto end = along_m_.begin() + static_cast<std::ptrdiff_t>(piece.end);
  const auto next = static_cast<std::size_t>(std::upper_bound(begin, end, along_m) - along_m_.begin());
  if (next >= piece.end) return 0.0;
  if (next == piece.first) return speed_mps_[piece.first];
  const double share = (along_m - along_m_[next - 1]) / (along_m_[next] - along_m_[next - 1]);
  return speed_mps_[next - 1] + share * (speed_mps_[next] - speed_mps_[next - 1]);
}

PathPlace TrackedPath::locate(const PathPiece& piece, std::size_t hint,
                              const Transform2<Map, Base>& map_from_base) const {
  const Point2<Map> here = map_from_base.translation();
  const std::size_t from = std::clamp(hint, piece.first, piece.end - 2);
  std::size_t best = from;
  double best_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i + 1 < piece.end && along_m_[i] <= along_m_[from] + kSearchAheadM; ++i) {
    const double away_m =
        distance_m(Segment2<Map>{path_.points[i].position, path_.points[i + 1].position}, here);
    if (away_m < best_m) {
      best_m = away_m;
      best = i;
    }
  }
  // On the last segment the vehicle may be past the end: measured along its direction, not clamped.
  const Point2<Map>& a = path_.points[best].position;
  const Point2<Map>& b = path_.points[best + 1].position;
  const double direction = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
  const double dx = here.x_m - a.x_m;
  const double dy = here.y_m - a.y_m;
  const double forward_m = dx * std::cos(direction) + dy * std::sin(direction);
  const double left_m = -dx * std::sin(direction) + dy * std::cos(direction);
  return {best, along_m_[best] + forward_m, left_m};
}

Point2<Map> TrackedPath::point_at(const PathPiece& piece, std::size_t hint, double along_m) const {
  std::size_t i = std::max(hint, piece.first);
  while (i + 2 < piece.end && along_m_[i + 1] < along_m) ++i;
  const Point2<Map>& a = path_.points[i].position;
  const Point2<Map>& b = path_.points[i + 1].position;
  const double share = (along_m - along_m_[i]) / (along_m_[i + 1] - along_m_[i]);
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
}

}  // namespace madori::control
