#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <utility>
#include <vector>

#include "localization/ndt_map/hybrid_map.hpp"
#include "simulation/factory.hpp"

namespace madori::soak {

/// Compares the living map at the end of a day with what stands in the virtual factory that day. Static:
/// walls, machines, shelves, desks. Semi-static: the day's pallets and clutter, and pallets that close an
/// aisle. Precision: of the cells of a layer, how many have such a thing within the tolerance. Recall: of the
/// surfaces that were in plain sight 0.25 m above the floor from three places or more, how many have a cell
/// of the layer within the tolerance. Around doors nothing is compared.
class MapTruth {
 public:
  explicit MapTruth(const simulation::Factory& factory) : factory_(factory) {}

  /// Now and then: what is in plain sight from where the vehicle is.
  void look();
  [[nodiscard]] nlohmann::json compare(const localization::HybridMap& map) const;

 private:
  struct Thing {
    std::vector<Point2<simulation::Building>> outline;
    bool semi_static = false;
  };
  using Place = std::pair<int, int>;
  [[nodiscard]] std::vector<Thing> things() const;
  [[nodiscard]] bool near_door(const Point2<simulation::Building>& p) const;
  [[nodiscard]] Point2<Map> on_map(const Point2<simulation::Building>& p) const;
  [[nodiscard]] Point2<simulation::Building> in_building(const Point2<Map>& p) const;

  const simulation::Factory& factory_;
  Point2<simulation::Building> looked_{1e9, 1e9};
  std::map<Place, std::pair<int, Point2<simulation::Building>>>
      seen_;  ///< 0.1 m; from how many places, and a point
};

}  // namespace madori::soak
