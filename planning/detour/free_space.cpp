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
#include "planning/detour/shorten.hpp"

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
    // By the curve's length, not by the parts of the space, which are not what is driven.
    return ob::StateSpace::validSegmentCount(from, to);  // NOLINT(bugprone-parent-virtual-call)
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
  const ob::PlannerTerminationCondition bounded([&] { return checks >= options.max_checks; });
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
  for (int round = 0; round < 2; ++round) corners = shortened(corners, options.turning_radius_m, is_free_at);
  const double length_m = dubins_length_m(corners, options.turning_radius_m);
  if (length_m >
      options.longest_m + options.longest_share * distance_m(start.translation(), goal.translation()))
    return Result<Path>::failure("the way around is too long, " +
                                 std::to_string(static_cast<int>(std::lround(length_m))) + " m");
  return to_path(corners, options);
}

}  // namespace madori::planning
