#include "app/cycle/site_in_building.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "core/angle.hpp"

namespace madori::app {
namespace {

/// A route is followed to about so much; what moves less is not planned anew.
constexpr double kFollowedToM = 0.02;
constexpr double kLedOverM = 3.0;  ///< the end of a way is led to a station that is thought elsewhere now

Transform2<Map, Base> carried_by(const localization::BentDrawing* bent, const Transform2<Map, Base>& pose) {
  return bent != nullptr ? bent->in_building(pose) : pose;
}

planning::RouteGraph carried_routes(const planning::RouteGraph& drawn,
                                    const localization::BentDrawing* bent) {
  std::vector<planning::RouteNode> nodes = drawn.nodes();
  for (planning::RouteNode& node : nodes) {
    const auto at = carried_by(bent, {node.position.x_m, node.position.y_m, node.heading_rad.value_or(0.0)});
    if (bent != nullptr) node.position = bent->place(node.position);
    if (node.heading_rad) node.heading_rad = at.yaw_rad();
  }
  return {std::move(nodes), drawn.legs()};
}

double heading_to(const Point2<Map>& from, const Point2<Map>& to) {
  return std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
}

std::optional<std::size_t> station_at_end(const planning::RouteGraph& routes, const Path& path) {
  if (path.points.empty()) return std::nullopt;
  for (const std::size_t node : routes.stations())
    if (distance_m(routes.nodes()[node].position, path.points.back().position) <= kFollowedToM) return node;
  return std::nullopt;
}

/// Bends the last metres so that the path ends there.
void lead_to(const Point2<Map>& end, Path& path) {
  const Point2<Map> last = path.points.back().position;
  const double x_m = end.x_m - last.x_m, y_m = end.y_m - last.y_m;
  double left_m = 0.0;
  Point2<Map> next = last, next_before = last;
  for (auto point = path.points.rbegin(); point != path.points.rend() && left_m < kLedOverM; ++point) {
    const Point2<Map> before = point->position;
    left_m += distance_m(before, next_before);
    const double left = std::max(0.0, 1.0 - left_m / kLedOverM);
    const double share = left * left * (3.0 - 2.0 * left);
    point->position = {before.x_m + share * x_m, before.y_m + share * y_m};
    const double was = heading_to(before, next_before), is = heading_to(point->position, next);
    if (left_m > 0.0) point->heading_rad = wrap_angle(point->heading_rad + is - was);
    next_before = before;
    next = point->position;
  }
}

}  // namespace

SiteInBuilding SiteInBuilding::carried(std::shared_ptr<const localization::BentDrawing> bent) const {
  SiteInBuilding other = *this;
  other.bent_ = std::move(bent);
  other.routes_ = other.bent_ ? carried_routes(*drawn_, other.bent_.get()) : *drawn_;
  other.walls_ = drawn_walls_;
  if (other.bent_) {
    std::vector<Segment2<Map>> segments;
    for (const auto& wall : other.bent_->stands) segments.push_back(wall.segment);
    other.walls_ = std::make_shared<const planning::WallGrid>(std::move(segments));
  }
  return other;
}

bool SiteInBuilding::differs(const std::shared_ptr<const localization::BentDrawing>& bent) const {
  if (bent == bent_) return false;
  if (!bent || !bent_ || bent->stands.size() != bent_->stands.size()) return true;
  const auto moved = [&](const planning::RouteNode& drawn, const planning::RouteNode& carried) {
    return distance_m(bent->place(drawn.position), carried.position) > kFollowedToM;
  };
  if (!std::ranges::equal(drawn_->nodes(), routes_.nodes(), std::not_fn(moved))) return true;
  const auto& before = bent_->stands;
  const auto& after = bent->stands;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (distance_m(before[i].segment.a, after[i].segment.a) > kFollowedToM ||
        distance_m(before[i].segment.b, after[i].segment.b) > kFollowedToM)
      return true;
  return false;
}

Transform2<Map, Base> SiteInBuilding::on_drawing(const Transform2<Map, Base>& in_building) const {
  return bent_ ? bent_->on_drawing(in_building) : in_building;
}

Point2<Map> SiteInBuilding::on_drawing(const Point2<Map>& in_building) const {
  return on_drawing(Transform2<Map, Base>(in_building.x_m, in_building.y_m, 0.0)).translation();
}

Transform2<Map, Base> SiteInBuilding::in_building(const Transform2<Map, Base>& on_drawing) const {
  return carried_by(bent_.get(), on_drawing);
}

Path SiteInBuilding::carry_to(const SiteInBuilding& other, Path path) const {
  const auto ends_at = station_at_end(routes_, path);
  for (PathPoint& point : path.points) {
    const Transform2<Map, Base> drawn =
        on_drawing(Transform2<Map, Base>(point.position.x_m, point.position.y_m, point.heading_rad));
    const Transform2<Map, Base> there = other.in_building(drawn);
    point.position = there.translation();
    point.heading_rad = there.yaw_rad();
  }
  if (ends_at) lead_to(other.routes_.nodes()[*ends_at].position, path);
  return path;
}

}  // namespace madori::app
