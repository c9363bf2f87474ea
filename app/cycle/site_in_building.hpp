#pragma once

#include <memory>

#include "core/path.hpp"
#include "localization/warp/bent_drawing.hpp"
#include "planning/obstacle_check/wall_grid.hpp"
#include "planning/route_graph/route_graph.hpp"

namespace madori::app {

/// What the vehicle drives by: routes and walls of the drawing where they stand in the building. Poses, paths
/// and obstacles are the building's metres (laid rigidly on the drawing); people read and say places on the
/// drawing. Immutable, shared.
class SiteInBuilding {
 public:
  /// As drawn.
  SiteInBuilding(planning::RouteGraph routes, std::shared_ptr<const planning::WallGrid> walls)
      : drawn_(std::make_shared<const planning::RouteGraph>(routes)),
        routes_(std::move(routes)),
        walls_(std::move(walls)),
        drawn_walls_(walls_) {}

  /// The same site by another belief of how the drawing lies; null: as drawn.
  [[nodiscard]] SiteInBuilding carried(std::shared_ptr<const localization::BentDrawing> bent) const;
  /// Whether `bent` puts a node or wall elsewhere by more than what a vehicle follows a path to.
  [[nodiscard]] bool differs(const std::shared_ptr<const localization::BentDrawing>& bent) const;

  [[nodiscard]] const planning::RouteGraph& routes() const { return routes_; }
  [[nodiscard]] const std::shared_ptr<const planning::WallGrid>& walls() const { return walls_; }
  [[nodiscard]] const std::shared_ptr<const localization::BentDrawing>& bent() const { return bent_; }

  [[nodiscard]] Point2<Map> on_drawing(const Point2<Map>& in_building) const;
  [[nodiscard]] Transform2<Map, Base> on_drawing(const Transform2<Map, Base>& in_building) const;
  [[nodiscard]] Transform2<Map, Base> in_building(const Transform2<Map, Base>& on_drawing) const;
  /// A path of this site, on `other`: it stays where it was on the drawing, and ends at the station at which
  /// it ended.
  [[nodiscard]] Path carry_to(const SiteInBuilding& other, Path path) const;

 private:
  std::shared_ptr<const planning::RouteGraph> drawn_;
  planning::RouteGraph routes_;
  std::shared_ptr<const planning::WallGrid> walls_;
  std::shared_ptr<const planning::WallGrid> drawn_walls_;
  std::shared_ptr<const localization::BentDrawing> bent_;
};

}  // namespace madori::app
