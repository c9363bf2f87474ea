#include "localization/slam/stretch.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/memory/fuse.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/pose_axes.hpp"
#include "localization/slam/grid_match.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// A frame of its own: the middle keyframe of the older stretch is its origin.
Pose as_pose(const Transform2<Base, Base>& motion) {
  return {motion.x_m(), motion.y_m(), motion.yaw_rad()};
}

Transform2<Base, Base> as_motion(const Pose& pose) {
  return {pose.x_m(), pose.y_m(), pose.yaw_rad()};
}

/// What the keyframes of a stretch saw around the guess, axes of its middle keyframe.
LocalMap stretch_map(const Memory& memory, const Stretch& from, const Transform2<Base, Base>& guess,
                     const StretchOptions& options) {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t k = from.first; k <= from.last; ++k)
    pieces.push_back({memory.keyframes()[k].scan.get(),
                      as_pose(memory.poses()[from.middle].inverse() * memory.poses()[k])});
  return {pieces, as_pose(guess).translation(), options.map_radius_m};
}

std::int64_t cell_of(const SurfacePoint& p, double side_m) {
  const auto ix = static_cast<std::int64_t>(std::floor(p.x_m / side_m));
  const auto iy = static_cast<std::int64_t>(std::floor(p.y_m / side_m));
  return (ix << 32) ^ (iy & 0xFFFFFFFF);
}

std::vector<std::size_t> evenly(const Stretch& stretch, std::size_t most) {
  const std::size_t n = stretch.last - stretch.first + 1;
  const std::size_t kept = std::min(n, most);
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < kept; ++k)
    some.push_back(stretch.first + (kept > 1 ? k * (n - 1) / (kept - 1) : stretch.middle - stretch.first));
  return some;
}

/// Some keyframes of two stretches, who are asked again and again what they say of each other.
class Witnesses {
 public:
  Witnesses(const Memory& memory, const Stretch& from, const Stretch& to, std::size_t count)
      : ours_(of(memory, from, count)), theirs_(of(memory, to, count)) {}

  /// With `to`'s middle seen from `from`'s at `motion`.
  [[nodiscard]] SightCount at(const Transform2<Base, Base>& motion) const {
    SightCount sum;
    for (const Witness& i : ours_) {
      const auto middle_from_i = i.from_middle.inverse() * motion;
      for (const Witness& j : theirs_) {
        const auto j_from_i = middle_from_i * j.from_middle;
        sum += i.ring.of(*j.scan, j_from_i);
        sum += j.ring.of(*i.scan, j_from_i.inverse());
      }
    }
    return sum;
  }

 private:
  struct Witness {
    const SurfaceScan* scan;
    SightRing ring;
    Transform2<Base, Base> from_middle;  ///< where it stands, axes of the stretch's middle
  };
  static std::vector<Witness> of(const Memory& memory, const Stretch& stretch, std::size_t count) {
    std::vector<Witness> some;
    const Pose& middle = memory.poses()[stretch.middle];
    for (const std::size_t k : evenly(stretch, count)) {
      const SurfaceScan& scan = *memory.keyframes()[k].scan;
      some.push_back({&scan, SightRing(scan), middle.inverse() * memory.poses()[k]});
    }
    return some;
  }

  std::vector<Witness> ours_, theirs_;
};

/// What the witnesses and the wheels say of a motion; the less it costs, the likelier it is.
class LeastContradicted {
 public:
  struct Place {
    Transform2<Base, Base> motion;
    SightCount sights;
    double cost = std::numeric_limits<double>::infinity();  ///< nats
  };

  LeastContradicted(const Witnesses& witnesses, const Transform2<Base, Base>& wheels,
                    const Eigen::Matrix3d& information, double reach_m)
      : witnesses_(witnesses), wheels_(wheels), information_(information), reach_m_(reach_m) {}

  [[nodiscard]] Place at(const Transform2<Base, Base>& motion) const {
    const Eigen::Vector3d e = pose_difference(motion, wheels_);
    const SightCount sights = witnesses_.at(motion);
    return {motion, sights, kNats * sights.contradiction() + 0.5 * e.dot(information_ * e)};
  }

  /// The cheapest within reach of `start`: along each axis, with steps that are halved where none is cheaper.
  [[nodiscard]] Place around(const Transform2<Base, Base>& start) const {
    Place here = at(start);
    for (double step = kStepM; step > kFinestM;) {
      Place next = here;
      for (const double by : {-step, step})
        for (const auto& motion : {moved(here.motion, by, 0.0, 0.0), moved(here.motion, 0.0, by, 0.0),
                                   moved(here.motion, 0.0, 0.0, by * kRadPerM)}) {
          if (distance_m(start.translation(), motion.translation()) > reach_m_) continue;
          if (const Place beside = at(motion); beside.cost < next.cost) next = beside;
        }
      if (next.cost < here.cost)
        here = next;
      else
        step /= 2.0;
    }
    return here;
  }

 private:
  static constexpr double kNats = 35.0;  // 12 ln 19: a scan's beams count as twelve, one in twenty is wrong
  static constexpr double kStepM = 0.2;  // little more than what passes for the same surface
  static constexpr double kFinestM = 0.02;
  static constexpr double kRadPerM = 0.3;  // a surface three metres away moves as far by either

  static Transform2<Base, Base> moved(const Transform2<Base, Base>& m, double x, double y, double yaw) {
    return {m.x_m() + x, m.y_m() + y, m.yaw_rad() + yaw};
  }

  const Witnesses& witnesses_;
  Transform2<Base, Base> wheels_;
  Eigen::Matrix3d information_;
  double reach_m_;  ///< farther off the scans say nothing of each other, and wheels that jumped pull for ever
};

}  // namespace

Stretch stretch_around(const std::vector<Keyframe>& keyframes, std::size_t middle,
                       const StretchOptions& options) {
  Stretch s{middle, middle, middle};
  const auto belongs = [&](std::size_t k, std::size_t away) {
    const double path_m = std::abs(keyframes[k].path_m - keyframes[middle].path_m);
    return away <= options.least_keyframes ||
           (away <= options.half_keyframes && path_m <= options.half_path_m);
  };
  while (s.first > 0 && !keyframes[s.first].cut && belongs(s.first - 1, middle - s.first + 1)) --s.first;
  while (s.last + 1 < keyframes.size() && !keyframes[s.last + 1].cut &&
         belongs(s.last + 1, s.last + 1 - middle))
    ++s.last;
  return s;
}

SurfaceScan stretch_scan(const Memory& memory, const Stretch& stretch, double spacing_m) {
  SurfaceScan all;
  all.stamp = memory.keyframes()[stretch.middle].scan->stamp;
  std::unordered_set<std::int64_t> taken;
  for (std::size_t k = stretch.first; k <= stretch.last; ++k) {
    const auto by = memory.poses()[stretch.middle].inverse() * memory.poses()[k];
    for (const SurfacePoint& p : memory.keyframes()[k].scan->points) {
      const SurfacePoint q = moved(by, p);
      if (taken.insert(cell_of(q, spacing_m)).second) all.points.push_back(q);
    }
  }
  return all;
}

SightCount stretch_sights(const Memory& memory, const Stretch& from, const Stretch& to,
                          const Transform2<Base, Base>& motion, std::size_t witnesses) {
  return Witnesses(memory, from, to, witnesses).at(motion);
}

bool is_seen_alike(const Memory& memory, const RelativeFactor& loop, const StretchOptions& options) {
  const auto& keyframes = memory.keyframes();
  const Stretch from = stretch_around(keyframes, static_cast<std::size_t>(loop.from), options);
  const Stretch to = stretch_around(keyframes, static_cast<std::size_t>(loop.to), options);
  return stretch_sights(memory, from, to, loop.motion, options.witnesses).contradiction() <=
         options.most_through;
}

StretchMatch lean_stretches(const Memory& memory, const Stretch& from, const Stretch& to,
                            const Transform2<Base, Base>& wheels, const Eigen::Matrix3d& covariance,
                            const Transform2<Base, Base>& laid, const StretchOptions& options) {
  constexpr double kNoWorse = 1.5;  // nats: half of chi-squared of three in the mean
  const Eigen::Matrix3d known = covariance.inverse();
  const Witnesses witnesses(memory, from, to, options.witnesses);
  const LeastContradicted least(witnesses, wheels, known, options.map_radius_m);
  auto place = least.around(wheels);
  if (const auto other = least.around(laid); other.cost < place.cost) place = other;
  Eigen::Matrix3d information =
      known + Eigen::Matrix3d(Eigen::Vector3d(kSightMarginM, kSightMarginM, kSightMarginShare)
                                  .cwiseAbs2()
                                  .cwiseInverse()
                                  .asDiagonal());
  if (const LocalMap map = stretch_map(memory, from, place.motion, options); !map.empty()) {
    const MatchResult match = map.refine(stretch_scan(memory, to, options.spacing_m), as_pose(place.motion),
                                         {as_pose(wheels), known});
    const auto fitted = least.at(as_motion(match.map_from_base));
    if (fitted.cost < place.cost + kNoWorse) {
      place = fitted;
      information = match.information + known;
    }
  }
  return {
      {static_cast<int>(from.middle), static_cast<int>(to.middle), place.motion, limited(information), false},
      place.sights};
}

std::optional<StretchMatch> match_stretches(const Memory& memory, const Stretch& from, const Stretch& to,
                                            const Transform2<Base, Base>& guess,
                                            const StretchOptions& options) {
  const LocalMap map = stretch_map(memory, from, guess, options);
  if (map.empty()) return std::nullopt;
  const SurfaceScan scan = stretch_scan(memory, to, options.spacing_m);
  const SearchWindow window{options.search_m, options.search_rad, options.search_m, options.search_rad};
  const SearchResult coarse = map.search(scan, as_pose(guess), window);
  const MatchResult match = map.refine(scan, coarse.map_from_base, {});
  if (!match.converged || match.inlier_share < options.least_inliers) return std::nullopt;
  const Transform2<Base, Base> motion = as_motion(match.map_from_base);
  const Eigen::Matrix3d information = limited(match.information);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(information, Eigen::EigenvaluesOnly);
  if (directions.eigenvalues()[0] < options.least_information) return std::nullopt;
  const SightCount sights = stretch_sights(memory, from, to, motion, options.witnesses);
  if (sights.both() < options.least_seen || sights.contradiction() > options.most_through)
    return std::nullopt;
  return StretchMatch{{static_cast<int>(from.middle), static_cast<int>(to.middle), motion, information, true},
                      sights};
}

}  // namespace madori::localization
