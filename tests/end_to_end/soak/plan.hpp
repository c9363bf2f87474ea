#pragma once

#include <optional>
#include <vector>

#include "planning/route_graph/route_graph.hpp"
#include "simulation/random.hpp"
#include "simulation/scenario/scenario.hpp"

namespace madori::soak {

/// What is asked for on the command line.
struct Wishes {
  int deliveries = 10;
  int days = 1;
  unsigned seed = 1;
  int kidnappings = 0;
  int dropouts = 0;
  double crossing_share = 0.35;  ///< of the deliveries: a person crosses the way
  double pallet_share = 0.12;    ///< of the deliveries: a pallet is put down on the way
};

struct Kidnapping {
  bool while_idle = false;
  double after_s = 0.0;  ///< since the order was given; while idle: before it is given
};

struct Dropout {
  simulation::FaultSpec fault;  ///< at_s counts from the order
};

/// One order to one station, and what befalls the vehicle on the way.
struct Delivery {
  int number = 0;  ///< over all days
  int station = 0;
  std::optional<Kidnapping> kidnapping;
  std::optional<Dropout> dropout;
  bool person_crosses = false;
  bool pallet_on_way = false;
};

/// A working day. Follows from the seed and its number alone, so that days can be driven in any order and by
/// several processes.
struct Day {
  int number = 0;
  int first_station = 0;  ///< where the vehicle stands in the morning
  std::optional<planning::RouteLeg> closed_aisle;
  std::vector<Delivery> deliveries;
};

/// Kidnappings and drop-outs are spread evenly over all deliveries; stations, persons and pallets are drawn.
[[nodiscard]] Day plan_day(int number, const Wishes& wishes, const planning::RouteGraph& routes);

/// Every random number of a day (delivery 0) or of a delivery (its number + 1) comes from one of these.
[[nodiscard]] inline simulation::Random chance_of(const Wishes& wishes, int day, int delivery) {
  return {wishes.seed, static_cast<std::uint64_t>(day), static_cast<std::uint64_t>(delivery)};
}

}  // namespace madori::soak
