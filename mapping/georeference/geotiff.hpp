#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/site/site.hpp"

namespace madori::mapping {

/// A grey picture that lies on the Map, rows from the top.
struct MapRaster {
  double cell_m = 0.05;
  Point2<Map> origin;  ///< of the lower-left pixel's corner
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> pixels;
};

/// The picture as a GeoTIFF (8 bit, one band, deflated), for QGIS and others: with a place on Earth in metres
/// east and north of it (azimuthal equidistant, WGS84), turned as the site is; without one in metres of the
/// Map frame, no reference system named. Throws Error where GDAL refuses.
[[nodiscard]] std::string geotiff(const MapRaster& raster,
                                  const std::optional<GeoreferenceRecord>& georeference);

}  // namespace madori::mapping
