#pragma once

#include <vector>

#include "simulation/scenario/scenario.hpp"

namespace madori::simulation {

/// What stands about on a day: clutter before the walls until the asked share of their length is hidden, and
/// pallets on free floor. Nothing comes nearer than keep_clear_m to the start and the lines to keep clear.
/// The same seed and day give the same arrangement. `walls` in the Plan frame.
[[nodiscard]] std::vector<SolidSpec> place_furniture(const std::vector<Segment2<Plan>>& walls,
                                                     const Scenario& scenario);

}  // namespace madori::simulation
