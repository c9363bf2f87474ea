#pragma once

#include <vector>

#include "core/stamp.hpp"
#include "core/transform2.hpp"
#include "planning/route_graph/route_graph.hpp"

namespace madori::planning {

/// A moment of a way that was driven by hand, on the drawing.
struct DrivenPose {
  Stamp stamp{};
  Transform2<Map, Base> map_from_base;
};

/// Adds a moment to a way where the vehicle has moved or turned since the last one; where it has stood, that
/// one's successor tells for how long. A jump, as when the place was found anew, begins a new way.
void note_way(std::vector<DrivenPose>& way, Stamp stamp, const Transform2<Map, Base>& map_from_base);
/// Its length, metres.
[[nodiscard]] double length_m(const std::vector<DrivenPose>& way);

/// The routes with the way driven as nodes and two-way legs: simplified (Douglas and Peucker 1973), a node at
/// its ends, its turns and its stops; joined with the nodes and legs that there are, and with itself where it
/// was driven twice. The routes as they are where the way is shorter than a node's size. Node IDs go on from
/// the largest.
[[nodiscard]] RouteGraph taught(const RouteGraph& routes, const std::vector<DrivenPose>& way);

}  // namespace madori::planning
