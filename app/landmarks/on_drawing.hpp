#pragma once

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/landmarks/landmark_hub.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// Landmark 0 on a drawing: what all landmarks saw, laid rigidly on the drawn walls within 0.9 m and 30
/// degrees (three sigmas of a pose that a person gives) of `about`.
[[nodiscard]] Transform2<Map, Map> landmarks_on_drawing(const localization::landmarks::LandmarkHub& hub,
                                                        const mapping::Walls& walls,
                                                        const Transform2<Map, Map>& about);

}  // namespace madori::app
