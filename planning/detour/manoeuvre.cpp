#include "planning/detour/manoeuvre.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>

namespace madori::planning {
namespace {

using Pose = Transform2<Map, Base>;

enum class Kind : std::uint8_t { Start, Forward, Backward, Turn };

struct Move {
  Kind kind;
  int turn;  ///< headings of the lattice
  Transform2<Base, Base> by;
  double cost_m;
};

struct Node {
  Pose pose;
  int heading = 0;
  Kind kind = Kind::Start;
  double cost_m = 0.0;
  std::size_t parent = 0;
};

std::vector<Move> moves_of(const ManoeuvreOptions& o) {
  const double angle = 2.0 * kPi / o.headings;
  const double chord_x = o.turning_radius_m * std::sin(angle);
  const double chord_y = o.turning_radius_m * (1.0 - std::cos(angle));
  const double arc_m = o.turning_radius_m * angle;
  std::vector<Move> moves;
  for (const double way : {1.0, -1.0}) {
    const Kind kind = way > 0.0 ? Kind::Forward : Kind::Backward;
    const double price = way > 0.0 ? 1.0 : o.backward_cost;
    moves.push_back({kind, 0, {way * o.step_m, 0.0, 0.0}, price * o.step_m});
    for (const int side : {1, -1})
      moves.push_back({kind, side, {way * chord_x, side * way * chord_y, 0.0}, price * arc_m});
  }
  for (const int side : {1, -1}) moves.push_back({Kind::Turn, side, {}, o.turn_cost_m});
  return moves;
}

class Search {
 public:
  Search(const Pose& start, const std::vector<ManoeuvreGoal>& goals,
         const std::vector<Point2<Map>>& obstacles, const WallGrid& walls, const CheckOptions& check,
         const ManoeuvreOptions& options)
      : start_(start), goals_(goals), walls_(walls), driving_(check), turning_(check), options_(options) {
    driving_.ends_margin_m = ends_margin_m(check, options.speed_mps);
    turning_.ends_margin_m = turning_.sides_margin_m = check.turn_margin_m;
    find_bounds();
    const double reach_m = check.vehicle.reach_m() + std::max(check.ends_margin_m, check.protective.ahead_m) +
                           check.field_margin_m;
    for (const Point2<Map>& p : obstacles)
      if (p.x_m > low_.x_m - reach_m && p.x_m < high_.x_m + reach_m && p.y_m > low_.y_m - reach_m &&
          p.y_m < high_.y_m + reach_m)
        obstacles_.push_back(p);
  }

  /// The last node of the cheapest way, and the goal.
  std::optional<std::pair<std::size_t, std::size_t>> run() {
    const auto moves = moves_of(options_);
    add({start_, 0, Kind::Start, 0.0, 0});
    while (!open_.empty() && nodes_.size() < options_.most_nodes) {
      const std::size_t at = open_.top().second;
      open_.pop();
      const Node node = nodes_[at];
      if (node.cost_m > best_[key(node)] + 1e-9) continue;
      if (node.kind != Kind::Start && !is_free_to(node)) continue;
      if (const auto goal = goal_at(node.pose)) return std::pair{at, *goal};
      for (const Move& move : moves) expand(node, at, move);
    }
    return std::nullopt;
  }
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void find_bounds() {
    low_ = high_ = start_.translation();
    for (const ManoeuvreGoal& goal : goals_) {
      low_ = {std::min(low_.x_m, goal.pose.x_m()), std::min(low_.y_m, goal.pose.y_m())};
      high_ = {std::max(high_.x_m, goal.pose.x_m()), std::max(high_.y_m, goal.pose.y_m())};
    }
    low_ = {low_.x_m - options_.room_m, low_.y_m - options_.room_m};
    high_ = {high_.x_m + options_.room_m, high_.y_m + options_.room_m};
  }

  void expand(const Node& node, std::size_t at, const Move& move) {
    const int heading = (node.heading + move.turn + options_.headings) % options_.headings;
    const auto moved = (node.pose * move.by).translation();
    const double yaw = start_.yaw_rad() + heading * 2.0 * kPi / options_.headings;
    Node next{{moved.x_m, moved.y_m, wrap_angle(yaw)}, heading, move.kind, node.cost_m + move.cost_m, at};
    if (node.kind != move.kind && node.kind != Kind::Start) next.cost_m += options_.change_cost_m;
    if (moved.x_m < low_.x_m || moved.x_m > high_.x_m || moved.y_m < low_.y_m || moved.y_m > high_.y_m)
      return;
    add(next);
  }

  void add(const Node& node) {
    const auto [known, is_new] = best_.try_emplace(key(node), node.cost_m);
    if (!is_new && node.cost_m >= known->second - 1e-9) return;
    known->second = node.cost_m;
    open_.push({node.cost_m + to_go_m(node.pose), nodes_.size()});
    nodes_.push_back(node);
  }

  [[nodiscard]] std::uint64_t key(const Node& node) const {
    const auto cell = [&](double m) {
      return static_cast<std::uint64_t>(std::lround(m / options_.step_m)) & 0xFFFFFU;
    };
    // How it came there is a part of it: changes cost.
    return cell(node.pose.x_m() - low_.x_m) << 36U | cell(node.pose.y_m() - low_.y_m) << 16U |
           static_cast<std::uint64_t>(node.heading) << 4U | static_cast<std::uint64_t>(node.kind);
  }

  [[nodiscard]] double to_go_m(const Pose& pose) const {
    double least = std::numeric_limits<double>::infinity();
    for (const ManoeuvreGoal& goal : goals_) {
      const double turn = std::abs(wrap_angle(goal.pose.yaw_rad() - pose.yaw_rad()));
      const double turns_m =
          turn * std::min(options_.turning_radius_m, options_.turn_cost_m * options_.headings / (2.0 * kPi));
      const double way_m = distance_m(goal.pose.translation(), pose.translation()) - options_.near_m;
      least = std::min(least, goal.rest_m + std::max(way_m, turns_m));
    }
    return least;
  }

  /// Near enough to a goal, from where the last degrees into its heading are free.
  [[nodiscard]] std::optional<std::size_t> goal_at(const Pose& pose) const {
    for (std::size_t i = 0; i < goals_.size(); ++i)
      if (distance_m(goals_[i].pose.translation(), pose.translation()) <= options_.near_m &&
          std::abs(wrap_angle(goals_[i].pose.yaw_rad() - pose.yaw_rad())) <= 1.01 * kPi / options_.headings &&
          is_free_between(pose, {pose.x_m(), pose.y_m(), goals_[i].pose.yaw_rad()}, obstacles_, walls_,
                          turning_))
        return i;
    return std::nullopt;
  }

  [[nodiscard]] bool is_free_to(const Node& node) const {
    return is_free_between(nodes_[node.parent].pose, node.pose, obstacles_, walls_,
                           node.kind == Kind::Turn ? turning_ : driving_);
  }

  Pose start_;
  const std::vector<ManoeuvreGoal>& goals_;
  std::vector<Point2<Map>> obstacles_;
  const WallGrid& walls_;
  CheckOptions driving_;
  CheckOptions turning_;
  const ManoeuvreOptions& options_;
  Point2<Map> low_, high_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, double> best_;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

PathPoint point_of(const Pose& pose, bool reverse, double speed_mps) {
  return {pose.translation(), reverse ? wrap_angle(pose.yaw_rad() + kPi) : pose.yaw_rad(), 0.0, speed_mps,
          reverse};
}

/// Strokes forward and backward; between two, and where it turns, the place is repeated.
Path path_of(const std::vector<Node>& way, const ManoeuvreOptions& options) {
  constexpr double kTurnAtOnceRad = kPi / 2.0;  ///< so that it turns to the side that was found free
  Path path;
  bool reverse = false;
  double turned_rad = 0.0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Node& node = way[i];
    if (node.kind == Kind::Start || node.kind == Kind::Turn) {
      if (i > 0) turned_rad += std::abs(wrap_angle(node.pose.yaw_rad() - way[i - 1].pose.yaw_rad()));
      const bool last = i + 1 == way.size() || way[i + 1].kind != Kind::Turn;
      if (last && i + 1 < way.size()) reverse = way[i + 1].kind == Kind::Backward;
      if (i > 0 && !last && turned_rad < kTurnAtOnceRad) continue;
      path.points.push_back(point_of(node.pose, reverse, options.speed_mps));
      turned_rad = 0.0;
      continue;
    }
    if (reverse != (node.kind == Kind::Backward)) {
      reverse = !reverse;
      path.points.push_back(point_of(way[i - 1].pose, reverse, options.speed_mps));
    }
    const double step_m = distance_m(way[i - 1].pose.translation(), node.pose.translation());
    PathPoint point = point_of(node.pose, reverse, options.speed_mps);
    point.curvature_per_m = wrap_angle(node.pose.yaw_rad() - way[i - 1].pose.yaw_rad()) / step_m;
    path.points.push_back(point);
  }
  return path;
}

}  // namespace

Result<Manoeuvre> find_manoeuvre(const Pose& start, const std::vector<ManoeuvreGoal>& goals,
                                 const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                 const CheckOptions& check, const ManoeuvreOptions& options) {
  using Answer = Result<Manoeuvre>;
  if (goals.empty()) return Answer::failure("no place to come back to the way is free");
  Search search(start, goals, obstacles, walls, check, options);
  const auto found = search.run();
  if (!found) return Answer::failure("no manoeuvre leads out of here");
  std::vector<Node> way;
  for (std::size_t at = found->first; at != 0; at = search.nodes()[at].parent)
    way.push_back(search.nodes()[at]);
  way.push_back(search.nodes()[0]);
  std::reverse(way.begin(), way.end());
  return Manoeuvre{path_of(way, options), found->second};
}

}  // namespace madori::planning
