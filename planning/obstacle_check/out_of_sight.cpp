#include "planning/obstacle_check/out_of_sight.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/angle.hpp"

namespace madori::planning {
namespace {

constexpr double kTurned = 0.35;  ///< sideways of his way by metre of it: 20 degrees
constexpr double kHeadM = 0.15;   ///< of his top that may be missed: lasers are degrees apart, and few hit it
constexpr double kLevelM = 0.05;  ///< above his top as a level lidar knows it, which is its own height

/// Whether someone so high stands within the view of lidars in direction, and below that of all in height.
class Blind {
 public:
  Blind(std::span<const LidarModel> lidars, const Transform2<Odom, Base>& odom_from_base)
      : lidars_(lidars), base_from_odom_(odom_from_base.inverse()) {}

  /// `nearer_m`: the place that lies so much nearer to the lidar is asked.
  [[nodiscard]] bool hides(const Point2<Odom>& place, double high_m, double nearer_m = 0.0) const {
    bool looked_at = false;
    for (const LidarModel& lidar : lidars_) {
      const SensorView view = SensorView::of(lidar);
      Point2<Base> at = base_from_odom_ * place;
      const double x = at.x_m - view.x_m, y = at.y_m - view.y_m, away_m = std::hypot(x, y);
      if (!view.looks_at(std::atan2(y, x))) continue;
      const double share = away_m > nearer_m ? nearer_m / away_m : 1.0;
      at = {at.x_m - share * x, at.y_m - share * y};
      const bool level = view.min_elevation_rad == view.max_elevation_rad;
      if (view.sees(at, 0.0, level ? high_m + kLevelM : high_m - kHeadM)) return false;
      looked_at = true;
    }
    return looked_at;
  }

 private:
  std::span<const LidarModel> lidars_;
  Transform2<Base, Odom> base_from_odom_;
};

/// The way that he had when he was lost.
struct Way {
  explicit Way(const LostMover& w)
      : from(w.last.at),
        speed_mps(std::hypot(w.last.vx_mps, w.last.vy_mps)),
        x(w.last.vx_mps / speed_mps),
        y(w.last.vy_mps / speed_mps) {}
  [[nodiscard]] Point2<Odom> at(double along_m) const {
    return {from.x_m + along_m * x, from.y_m + along_m * y};
  }
  /// How far along it a place lies; one behind him at its beginning.
  [[nodiscard]] double along_m(const Point2<Odom>& place) const {
    return std::max(0.0, (place.x_m - from.x_m) * x + (place.y_m - from.y_m) * y);
  }

  Point2<Odom> from;
  double speed_mps, x, y;
};

/// Where he may be by now and is not seen: discs along his way, wider by what he may have turned.
template <class Visit>
void places(const LostMover& w, const Blind& blind, Stamp now, Visit&& visit) {
  constexpr double kStepM = 0.15;
  const Way way(w);
  const double far_m = std::max(0.0, way.speed_mps * to_seconds(now - w.seen));
  for (double s = 0.0; s <= far_m; s += kStepM) {
    const Point2<Odom> at = way.at(s);
    if (blind.hides(at, w.high_m))
      visit(at, w.last.radius_m + kTurned * s);
    else if (s > 0.0)
      return;  // there he would have been seen
  }
}

/// Whether someone who is followed since he was lost may be he: on the way that he had, or back where he
/// went.
bool may_be(const LostMover& w, const MovingObjects::Track& track, Stamp now) {
  constexpr double kSlackM = 1.0;      // from where he was lost until he is surely in sight
  constexpr double kFastestMps = 2.0;  // of who has been out of sight
  if (track.since <= w.seen) return false;
  const Point2<Odom>& there = track.sightings.back().at;
  const Way way(w);
  const double along_m = way.along_m(there);
  const double aside_m = distance_m(there, way.at(along_m));
  return along_m <= kSlackM + kFastestMps * to_seconds(now - w.seen) &&
         aside_m <= kSlackM + kTurned * along_m;
}

void add_disc(const Point2<Odom>& at, double radius_m, std::vector<Point2<Odom>>& points) {
  constexpr int kCorners = 8;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * kPi * i / kCorners;
    points.push_back({at.x_m + radius_m * std::cos(angle), at.y_m + radius_m * std::sin(angle)});
  }
}

}  // namespace

void OutOfSight::clear() {
  walkers_.clear();
  points_.clear();
}

void OutOfSight::update(const MovingObjects& objects, std::span<const LidarModel> lidars,
                        const Transform2<Odom, Base>& odom_from_base, Stamp now) {
  constexpr double kAboutS = 15.0;  // most walk out within 3 s; one in twenty is not noticed when he does
  constexpr double kAboutM = 2.0;   // he may have turned, or walk beside the vehicle
  constexpr double kRimM = 1.0;  // around the places without sight: who comes from elsewhere is another one
  const Blind blind(lidars, odom_from_base);
  for (const auto& track : objects.tracks()) {
    const Point2<Odom>& there = track.sightings.back().at;
    const auto he = std::find_if(walkers_.begin(), walkers_.end(), [&](const LostMover& w) {
      return may_be(w, track, now) && !blind.hides(there, w.high_m) && blind.hides(there, w.high_m, kRimM);
    });
    if (he != walkers_.end()) walkers_.erase(he);
  }
  const auto& lost = objects.lost();
  std::copy_if(lost.begin(), lost.end(), std::back_inserter(walkers_),
               [&](const LostMover& m) { return blind.hides(m.last.at, m.high_m); });
  points_.clear();
  std::erase_if(walkers_, [&](const LostMover& w) {
    const std::size_t before = points_.size();
    places(w, blind, now, [&](const auto& at, double radius_m) { add_disc(at, radius_m, points_); });
    if (points_.size() > before) return false;
    const double since_s = to_seconds(now - w.seen);
    return !(since_s >= 0.0 && since_s < kAboutS) || !blind.hides(w.last.at, w.high_m, kAboutM);
  });
}

}  // namespace madori::planning
