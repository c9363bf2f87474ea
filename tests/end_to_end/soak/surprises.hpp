#pragma once

#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "simulation/factory.hpp"
#include "simulation/random.hpp"

namespace madori::soak {

/// What is put in the way of the vehicle, and taken away again.
class Surprises {
 public:
  Surprises(simulation::Factory& factory, const simulation::Scenario& scenario,
            const app::CycleConfig& config);

  /// Pallets side by side across the middle of a leg.
  void close_aisle(const planning::RouteLeg& leg);
  /// A pallet on the way ahead, up to half a metre beside it. False where the way left is too short.
  bool put_pallet(const app::CycleState& state, simulation::Random& random);
  /// A person who walks across the way ahead and back until the delivery is made. False as above, or where
  /// walls stand beside the way.
  bool send_person(const app::CycleState& state, simulation::Random& random);
  /// The vehicle is lifted and put down near another node; who means to help puts it where it can turn. Where
  /// it stands now.
  Transform2<Map, Base> carry_away(simulation::Random& random, bool to_help = false);
  /// Everything that was put in the way for one delivery.
  void clear();
  /// Takes away what blocks the way there; false where nothing was put near.
  bool take_away_near(const Point2<Map>& place);
  /// Whether a route that avoids everything put down leads from the vehicle to the node.
  [[nodiscard]] bool another_way(std::size_t goal) const;

  /// Whether anything as high as the vehicle's body stands within a step of a place.
  [[nodiscard]] bool stands_at(const Point2<Map>& place) const;

 private:
  [[nodiscard]] bool has_room(const Transform2<Map, Base>& pose) const;
  struct Thing {
    std::string name;
    Point2<Map> place;
    bool stays = false;  ///< all day
    bool walks = false;
  };
  void add(simulation::MoverKind kind, const std::vector<Point2<Map>>& path, double yaw_rad, double speed_mps,
           bool stays);

  simulation::Factory& factory_;
  const app::CycleConfig& config_;
  Transform2<simulation::Plan, Map> plan_from_map_;
  std::vector<Thing> things_;
  int number_ = 0;
};

}  // namespace madori::soak
