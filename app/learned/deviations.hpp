#pragma once

#include <string>
#include <vector>

#include "localization/warp/warp_fit.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {

inline constexpr const char* kWarpFile = "learned/warp.txt";

enum class Standing { Unseen, AsDrawn, Displaced };
[[nodiscard]] const char* to_string(Standing standing);

/// Where one drawn wall stands. Both segments in the same axes: the building laid rigidly on the drawing.
struct Deviation {
  int wall_id = 0;
  Segment2<Map> drawn;
  Segment2<Map> stands;   ///< by the learned warp and the wall's own offset; Building metres
  double across_m = 0.0;  ///< of its middle, to the left of a -> b
  double own_m = 0.0;     ///< the part that its surroundings do not share
  double sigma_m = 0.0;   ///< of across_m
  double seen_m = 0.0;    ///< of its surface
  Standing standing = Standing::Unseen;
};

/// Wall by wall, in the order of the walls. Displaced is what stands beside its line by more than two sigmas.
[[nodiscard]] std::vector<Deviation> deviations(const mapping::Walls& drawn,
                                                const localization::WarpFit& fit);

/// `wall_id,x1,y1,x2,y2,stands_x1,stands_y1,stands_x2,stands_y2,across_m,own_m,sigma_m,seen_m,standing`.
[[nodiscard]] std::string deviations_csv(const std::vector<Deviation>& rows);
/// GeoJSON, a line a wall where it stands, with the table's columns as properties. WGS84 where the site is
/// georeferenced, else Map metres, which the member `coordinates_are` says.
[[nodiscard]] std::string deviations_geojson(const mapping::Site& site, const std::vector<Deviation>& rows);
/// PNG bytes: the walls where they stand, by how far that is from where they are drawn (thin).
[[nodiscard]] std::vector<std::uint8_t> deviations_plot(const mapping::Walls& drawn,
                                                        const std::vector<Deviation>& rows);

}  // namespace madori::app
