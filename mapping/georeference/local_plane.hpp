#pragma once

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/georeference/tile_math.hpp"
#include "mapping/site/site.hpp"

namespace madori::mapping {

/// The tangent plane of WGS84 at a place, metres east and north (GeographicLib::LocalCartesian, height 0).
class LocalPlane {
 public:
  explicit LocalPlane(const LatLon& origin) : origin_(origin) {}
  [[nodiscard]] Point2<Enu> enu_of(const LatLon& place) const;
  [[nodiscard]] LatLon place_of(const Point2<Enu>& point) const;

 private:
  LatLon origin_;
};

/// Where a point of the Map lies on Earth.
[[nodiscard]] LatLon place_of(const GeoreferenceRecord& georeference, const Point2<Map>& point);

/// The same once the Map is `factor` times as large, and what lay at `held` has kept its place on Earth.
[[nodiscard]] GeoreferenceRecord rescaled(const GeoreferenceRecord& georeference, const Point2<Map>& held,
                                          double factor);

}  // namespace madori::mapping
