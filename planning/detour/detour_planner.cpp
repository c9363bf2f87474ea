#include "planning/detour/detour_planner.hpp"

#include <algorithm>
#include <utility>

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
  return {point.position.x_m, point.position.y_m, point.heading_rad};
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
    whole.points.insert(whole.points.end(),
                        request.path.points.begin() + static_cast<std::ptrdiff_t>(rejoin) + 1,
                        request.path.points.end());
    const PathCheck free = check_path(whole, 0, 1e3, request.obstacles, walls, check);
    if (free.blocked() && free.first_blocked < joined) continue;
    answer.rejoin = joined;
    answer.path = std::move(whole);
    return answer;
  }
  return answer;
}

}  // namespace

DetourAnswer plan_detour(const DetourRequest& request, const CheckOptions& ordinary,
                         const DetourOptions& options) {
  const CheckOptions check = with_margins(ordinary, request.squeeze);
  DetourAnswer answer = plan_within(request, with_room(check, options.room_m), options);
  return answer.path ? answer : plan_within(request, check, options);
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
