#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/trajectory_file.hpp"
#include "localization/landmarks/landmark_hub.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// A landmark as it is written: where it lies in the Map frame, and how sure that is.
struct PlacedLandmark {
  Transform2<Map, Base> map_from_landmark;
  localization::landmarks::Matrix3 covariance;  ///< (x, y, yaw), Map axes; of the place seen from landmark 0
  double published_sigma_m = 0.0;               ///< the scalar form on the same measurements
  double published_sigma_rad = 0.0;
};
[[nodiscard]] std::vector<PlacedLandmark> place_landmarks(const localization::landmarks::LandmarkHub& hub,
                                                          const Transform2<Map, Map>& map_from_origin);

/// `id,x_m,y_m,yaw_deg,sigma_x_m,sigma_y_m,sigma_yaw_deg,published_sigma_m,published_sigma_deg`
[[nodiscard]] std::string landmarks_csv(const std::vector<PlacedLandmark>& landmarks);
/// Points and edges as GeoJSON in metres of the Map frame (no geographic coordinates, which the property
/// `frame` says).
[[nodiscard]] std::string landmarks_geojson(const std::vector<PlacedLandmark>& landmarks,
                                            const localization::landmarks::LandmarkHub& hub);
/// The graph for Graphviz (`neato -n`), each edge with its length and sigma.
[[nodiscard]] std::string landmarks_dot(const std::vector<PlacedLandmark>& landmarks,
                                        const localization::landmarks::LandmarkHub& hub);
/// PNG: walls (where there is a drawing), ways of the agents, landmarks with 2 sigma ellipses, edges.
[[nodiscard]] std::vector<std::uint8_t> landmarks_picture(const std::vector<PlacedLandmark>& landmarks,
                                                          const localization::landmarks::LandmarkHub& hub,
                                                          const std::vector<std::vector<StampedPose>>& ways,
                                                          const mapping::Walls& walls);

}  // namespace madori::app
