#pragma once

/// Tag types of the coordinate frames. All frames are right-handed, counter-clockwise positive (REP 103).
namespace madori {

/// Metres, x right and y up on the drawing; origin at the lower-left corner of the drawing's pixel grid.
struct Map {};
/// Metres, metric: the building as it is, laid rigidly on the drawing. On an exact drawing the same numbers as
/// Map; else a learned warp relates the two.
struct Building {};
/// Metres, where the wheels say the vehicle is; continuous, drifts.
struct Odom {};
/// Metres, between the driven wheels on the floor; x forward, y left, z up.
struct Base {};
/// Metres, the lidar's own frame; x forward, y left, z up.
struct Lidar {};
/// Metres, local east-north-up tangent plane at the georeference of the site.
struct Enu {};

}  // namespace madori
