#pragma once

#include "localization/warp/warp_fit.hpp"

namespace madori::localization {

/// Where a place of a drawn room lies in the room as it stands (Building metres, typed Map): where the warp
/// carries it, and beside that so that its distances from the walls within 4 m around it, as far as these
/// were seen, keep their proportions. `drawn` as given to the fit.
[[nodiscard]] Point2<Map> place_by_walls(const mapping::Walls& drawn, const WarpFit& fit,
                                         const Point2<Map>& place);

}  // namespace madori::localization
