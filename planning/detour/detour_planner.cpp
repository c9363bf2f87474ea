#include "planning/detour/detour_planner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.hpp"
#include "core/thread_role.hpp"

namespace madori::planning {
namespace {

/// Points of the route at which a way through the free space may come back, nearest first.
std::vector<std::size_t> rejoin_points(const DetourRequest& request, const CheckOptions& check) {
  constexpr double kFirstM = 0.4;
  constexpr double kStepM = 1.0;
  constexpr std::size_t kMost = 3;
  std::vector<std::size_t> points;
  double wanted_m = check.vehicle.rear_m + check.ends_margin_m + kFirstM;
  double passed_m = 0.0;
  const auto& path = request.path.points;
  for (std::size_t i = request.check.last_blocked + 1; i < path.size() && points.size() < kMost; ++i) {
    passed_m += distance_m(path[i - 1].position, path[i].position);
    if (passed_m < wanted_m && i + 1 != path.size()) continue;
    points.push_back(i);
    wanted_m = passed_m + kStepM;
  }
  return points;
}

Transform2<Map, Base> pose_at(const PathPoint& point) {
  return {point.position.x_m, point.position.y_m, point.facing_rad()};
}

/// What comes on the route after the point at which it was come back to. Where the route goes on the other
/// way, forward or backward, the place is repeated: there a new stroke begins.
void append_rest(Path& way, const Path& route, std::size_t point) {
  if (way.points.back().reverse != route.points[point].reverse) way.points.push_back(route.points[point]);
  way.points.insert(way.points.end(), route.points.begin() + static_cast<std::ptrdiff_t>(point) + 1,
                    route.points.end());
}

/// Beside the vehicle, more than what it is checked with while it drives: no curve is followed exactly.
CheckOptions with_room(CheckOptions check, double room_m) {
  check.sides_margin_m += room_m;
  check.turn_margin_m += room_m;
  check.wall_margin_m += room_m;
  return check;
}

DetourAnswer plan_within(const DetourRequest& request, const CheckOptions& check,
                         const DetourOptions& options) {
  const WallGrid& walls = *request.walls;
  DetourAnswer answer{request.id, std::nullopt, 0, ""};
  auto side = request.turn_free ? side_detour(request.path, request.from, request.check, request.obstacles,
                                              walls, check, options.side)
                                : Result<Detour>::failure("no room to turn");
  if (side) {
    answer.rejoin = side.value().rejoin;
    answer.path = std::move(side).value().path;
    return answer;
  }
  answer.reason = side.reason();
  for (const std::size_t rejoin : rejoin_points(request, check)) {
    const PathPoint& point = request.path.points[rejoin];
    if (!is_free(pose_at(point), request.obstacles, walls, check)) continue;
    const auto around = free_space_path(request.map_from_base, pose_at(point), request.obstacles, walls,
                                        check, options.free_space);
    if (!around) {
      answer.reason = around.reason();
      continue;
    }
    Path whole = around.value();
    const std::size_t joined = whole.points.size();
    append_rest(whole, request.path, rejoin);
    const PathCheck free = check_path(whole, 0, 1e3, request.obstacles, walls, check);
    if (free.blocked() && free.first_blocked < joined) continue;
    answer.rejoin = joined;
    answer.path = std::move(whole);
    return answer;
  }
  return answer;
}

/// A pose at a point of the route, from which the rest of the route is driven.
struct Rejoin {
  std::size_t point;
  Transform2<Map, Base> pose;
};

/// Where a manoeuvre may come back to the route: the points beyond what blocks it at which the vehicle stands
/// free; at its end in any heading, where none is asked for.
std::vector<Rejoin> free_rejoins(const DetourRequest& request, const CheckOptions& check,
                                 const ManoeuvreOptions& options) {
  constexpr double kWithinM = 4.0;
  std::vector<Rejoin> found;
  const auto add = [&](std::size_t i, const Transform2<Map, Base>& pose) {
    if (is_free(pose, request.obstacles, *request.walls, check)) found.push_back({i, pose});
  };
  const auto& path = request.path.points;
  double passed_m = 0.0;
  for (std::size_t i = request.check.last_blocked + 1; i < path.size() && passed_m < kWithinM; ++i) {
    passed_m += distance_m(path[i - 1].position, path[i].position);
    add(i, pose_at(path[i]));
  }
  if (passed_m >= kWithinM || !request.any_end_heading || path.empty()) return found;
  for (int k = 1; k < options.headings; ++k)
    add(path.size() - 1, {path.back().position.x_m, path.back().position.y_m,
                          wrap_angle(path.back().facing_rad() + 2.0 * kPi * k / options.headings)});
  return found;
}

/// Out of a narrow place and back to the route.
DetourAnswer manoeuvre_within(const DetourRequest& request, const CheckOptions& check,
                              const ManoeuvreOptions& options) {
  DetourAnswer answer{request.id, std::nullopt, 0, ""};
  const auto& path = request.path.points;
  const auto rejoins = free_rejoins(request, check, options);
  std::vector<double> along_m(path.size(), 0.0);
  for (std::size_t i = 1; i < path.size(); ++i)
    along_m[i] = along_m[i - 1] + distance_m(path[i - 1].position, path[i].position);
  std::vector<ManoeuvreGoal> goals;
  for (const Rejoin& rejoin : rejoins) {
    const double off_rad = wrap_angle(rejoin.pose.yaw_rad() - path[rejoin.point].facing_rad());
    goals.push_back({rejoin.pose, along_m[rejoins.back().point] - along_m[rejoin.point] +
                                      std::abs(off_rad) * options.other_heading_cost_m});
  }
  auto found =
      find_manoeuvre(request.map_from_base, goals, request.obstacles, *request.walls, check, options);
  if (!found) {
    answer.reason = found.reason();
    return answer;
  }
  const Rejoin& joins = rejoins[found.value().goal];
  Path whole = std::move(found).value().path;
  PathPoint turn = path[joins.point];  // the last few degrees, on the spot
  turn.position = whole.points.back().position;
  turn.heading_rad = wrap_angle(joins.pose.yaw_rad() + (turn.reverse ? kPi : 0.0));
  turn.curvature_per_m = 0.0;
  whole.points.push_back(turn);
  answer.rejoin = whole.points.size() - 1;
  append_rest(whole, request.path, joins.point);
  answer.path = std::move(whole);
  return answer;
}

}  // namespace

DetourAnswer plan_detour(const DetourRequest& request, const CheckOptions& ordinary,
                         const DetourOptions& options) {
  const CheckOptions check = with_margins(ordinary, request.squeeze);
  DetourAnswer answer = plan_within(request, with_room(check, options.room_m), options);
  if (!answer.path) answer = plan_within(request, check, options);
  // A way along the very margins is refused in the next look: each shows an edge a little elsewhere.
  for (const double share : {1.0, 0.5, 0.0}) {
    if (answer.path) break;
    answer = manoeuvre_within(request, with_room(check, share * options.room_m), options.manoeuvre);
  }
  return answer;
}

DetourPlanner::DetourPlanner(CheckOptions check, DetourOptions options)
    : check_(check), options_(options), thread_([this] { run(); }) {}

DetourPlanner::~DetourPlanner() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void DetourPlanner::submit(DetourRequest request) {
  {
    const std::scoped_lock lock(mutex_);
    request_ = std::move(request);
  }
  wake_.notify_one();
}

std::optional<DetourAnswer> DetourPlanner::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(answer_, std::nullopt);
}

void DetourPlanner::run() {
  (void)take_role("detour planner", ThreadRole::Ordinary);
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || request_.has_value(); });
    if (stop_) return;
    const DetourRequest request = *std::exchange(request_, std::nullopt);
    lock.unlock();
    DetourAnswer answer = plan_detour(request, check_, options_);
    lock.lock();
    answer_ = std::move(answer);
  }
}

}  // namespace madori::planning
