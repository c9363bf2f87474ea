#include "planning/detour/free_space.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "planning/detour/dubins.hpp"

namespace madori::planning {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

Transform2<Map, Base> pose_of(const ob::State* state) {
  const auto* s = state->as<ob::SE2StateSpace::StateType>();
  return {s->getX(), s->getY(), s->getYaw()};
}

void set_state(ob::State* state, const Transform2<Map, Base>& pose) {
  auto* s = state->as<ob::SE2StateSpace::StateType>();
  s->setXY(pose.x_m(), pose.y_m());
  s->setYaw(pose.yaw_rad());
}

/// Poses of the plane, joined by Dubins curves.
class Space final : public ob::SE2StateSpace {
 public:
  explicit Space(double radius_m) : radius_m_(radius_m) {}

  [[nodiscard]] DubinsCurve curve(const ob::State* from, const ob::State* to) const {
    return shortest_dubins(pose_of(from), pose_of(to), radius_m_);
  }
  [[nodiscard]] bool isMetricSpace() const override { return false; }
  [[nodiscard]] bool hasSymmetricDistance() const override { return false; }
  [[nodiscard]] bool hasSymmetricInterpolate() const override { return false; }
  double distance(const ob::State* from, const ob::State* to) const override {
    return curve(from, to).length_m();
  }
  unsigned validSegmentCount(const ob::State* from, const ob::State* to) const override {
    return ob::StateSpace::validSegmentCount(from, to);
  }
  void interpolate(const ob::State* from, const ob::State* to, double t, ob::State* state) const override {
    const DubinsCurve way = curve(from, to);
    set_state(state, way.pose_at(t * way.length_m()));
  }

 private:
  double radius_m_;
};

/// Checks a curve every few centimetres, its end included, its start not.
class Motions final : public ob::MotionValidator {
 public:
  Motions(const ob::SpaceInformationPtr& information, const Space& space)
      : ob::MotionValidator(information), space_(space) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    if (!si_->isValid(to)) return false;
    const DubinsCurve way = space_.curve(from, to);
    const unsigned steps = space_.validSegmentCount(from, to);
    ob::ScopedState<Space> between(si_->getStateSpace());
    for (unsigned i = 1; i < steps; ++i) {
      set_state(between.get(), way.pose_at(way.length_m() * i / steps));
      if (!si_->isValid(between.get())) return false;
    }
    return true;
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    last_valid.second = 0.0;  // not asked for by RRT-Connect: a motion that fails counts for nothing
    return checkMotion(from, to);
  }

 private:
  const Space& space_;
};

ob::RealVectorBounds bounds_around(const Transform2<Map, Base>& a, const Transform2<Map, Base>& b,
                                   double room_m) {
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, std::min(a.x_m(), b.x_m()) - room_m);
  bounds.setHigh(0, std::max(a.x_m(), b.x_m()) + room_m);
  bounds.setLow(1, std::min(a.y_m(), b.y_m()) - room_m);
  bounds.setHigh(1, std::max(a.y_m(), b.y_m()) + room_m);
  return bounds;
}

using Pose = Transform2<Map, Base>;

/// Poses along the curves from pose to pose, about `step_m` apart, the first and the last included.
std::vector<Pose> sampled(const std::vector<Pose>& corners, double radius_m, double step_m) {
  std::vector<Pose> poses{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const DubinsCurve way = shortest_dubins(corners[i - 1], corners[i], radius_m);
    const int steps = std::max(1, static_cast<int>(std::lround(way.length_m() / step_m)));
    for (int k = 1; k < steps; ++k) poses.push_back(way.pose_at(way.length_m() * k / steps));
    poses.push_back(corners[i]);
  }
  return poses;
}

double length_of(const std::vector<Pose>& corners, double radius_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    length_m += shortest_dubins(corners[i - 1], corners[i], radius_m).length_m();
  return length_m;
}

/// What random trees find wanders: from each pose the furthest one is taken that a shorter free curve
/// reaches. (OMPL's own simplification trusts the triangle inequality, which these curves do not keep.)
template <class IsFree>
std::vector<Pose> shortened(const std::vector<Pose>& corners, const FreeSpaceOptions& options,
                            IsFree&& is_free_at) {
  constexpr double kStepM = 0.3;
  constexpr double kCheckM = 0.05;
  constexpr double kGainM = 0.05;
  constexpr int kMostChecks = 60'000;
  const auto poses = sampled(corners, options.turning_radius_m, kStepM);
  std::vector<double> along_m{0.0};
  for (std::size_t i = 1; i < poses.size(); ++i)
    along_m.push_back(along_m.back() +
                      shortest_dubins(poses[i - 1], poses[i], options.turning_radius_m).length_m());
  int checks = 0;
  const auto is_free_way = [&](const DubinsCurve& way) {
    const int steps = std::max(1, static_cast<int>(std::ceil(way.length_m() / kCheckM)));
    for (int k = 1; k < steps; ++k)
      if (++checks > kMostChecks || !is_free_at(way.pose_at(way.length_m() * k / steps))) return false;
    return true;
  };
  std::vector<Pose> shorter{poses.front()};
  for (std::size_t i = 0; i + 1 < poses.size();) {
    std::size_t next = i + 1;
    for (std::size_t k = poses.size() - 1; k > i + 1 && checks <= kMostChecks; --k) {
      const DubinsCurve direct = shortest_dubins(poses[i], poses[k], options.turning_radius_m);
      if (direct.length_m() > along_m[k] - along_m[i] - kGainM || !is_free_way(direct)) continue;
      next = k;
      break;
    }
    shorter.push_back(poses[next]);
    i = next;
  }
  return shorter;
}

Path to_path(const std::vector<Pose>& corners, const FreeSpaceOptions& options) {
  Path path;
  for (const Pose& pose : sampled(corners, options.turning_radius_m, options.spacing_m))
    path.points.push_back({pose.translation(), pose.yaw_rad(), 0.0, options.speed_mps});
  // Headings are those of the curve already; only the curvature is missing.
  for (std::size_t i = 1; i + 1 < path.points.size(); ++i) {
    const PathPoint& a = path.points[i - 1];
    const PathPoint& b = path.points[i + 1];
    const double way_m = distance_m(a.position, b.position);
    if (way_m > 1e-6) path.points[i].curvature_per_m = wrap_angle(b.heading_rad - a.heading_rad) / way_m;
  }
  return path;
}

}  // namespace

Result<Path> free_space_path(const Transform2<Map, Base>& start, const Transform2<Map, Base>& goal,
                             const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                             const CheckOptions& check, const FreeSpaceOptions& options) {
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(options.seed);
  const auto space = std::make_shared<Space>(options.turning_radius_m);
  space->setBounds(bounds_around(start, goal, options.room_m));
  og::SimpleSetup setup(space);
  std::uint64_t checks = 0;
  const auto bounded = options.max_checks > 0
                           ? ob::PlannerTerminationCondition([&] { return checks >= options.max_checks; })
                           : ob::timedPlannerTerminationCondition(options.time_limit_s);
  // Where the distance is not symmetric, RRT-Connect may extend a tree for ever without asking whether it
  // shall end; once nothing is valid it ends.
  setup.setStateValidityChecker([&](const ob::State* state) {
    ++checks;
    return !bounded() && space->satisfiesBounds(state) && is_free(pose_of(state), obstacles, walls, check);
  });
  setup.getSpaceInformation()->setMotionValidator(
      std::make_shared<Motions>(setup.getSpaceInformation(), *space));
  setup.getSpaceInformation()->setStateValidityCheckingResolution(0.05 / space->getMaximumExtent());
  ob::ScopedState<Space> from(space);
  ob::ScopedState<Space> to(space);
  set_state(from.get(), start);
  set_state(to.get(), goal);
  setup.setStartAndGoalStates(from, to);
  setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
  if (setup.solve(bounded) != ob::PlannerStatus::EXACT_SOLUTION)
    return Result<Path>::failure("no free way was found within the time allowed");
  std::vector<Pose> corners;
  for (const ob::State* state : setup.getSolutionPath().getStates()) corners.push_back(pose_of(state));
  const auto is_free_at = [&](const Pose& pose) { return is_free(pose, obstacles, walls, check); };
  for (int round = 0; round < 2; ++round) corners = shortened(corners, options, is_free_at);
  const double length_m = length_of(corners, options.turning_radius_m);
  if (length_m >
      options.longest_m + options.longest_share * distance_m(start.translation(), goal.translation()))
    return Result<Path>::failure("the way around is too long, " +
                                 std::to_string(static_cast<int>(std::lround(length_m))) + " m");
  return to_path(corners, options);
}

}  // namespace madori::planning
