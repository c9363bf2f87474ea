#pragma once

#include <functional>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::planning {

/// Poses along the Dubins curves from pose to pose, about `step_m` apart, the first and the last included.
[[nodiscard]] std::vector<Transform2<Map, Base>> sampled(const std::vector<Transform2<Map, Base>>& corners,
                                                         double radius_m, double step_m);

/// Of the curves from pose to pose.
[[nodiscard]] double dubins_length_m(const std::vector<Transform2<Map, Base>>& corners, double radius_m);

/// What random trees find wanders: from each pose the furthest one is taken that a shorter free curve
/// reaches; never longer than before. OMPL's own simplification trusts the triangle inequality, which these
/// curves do not keep. The search is bounded. Preconditions: at least one pose; the given way is free.
[[nodiscard]] std::vector<Transform2<Map, Base>> shortened(
    const std::vector<Transform2<Map, Base>>& corners, double radius_m,
    const std::function<bool(const Transform2<Map, Base>&)>& is_free_at);

}  // namespace madori::planning
