#include "mapping/georeference/local_plane.hpp"

#include <GeographicLib/LocalCartesian.hpp>

#include "core/transform2.hpp"

namespace madori::mapping {

Point2<Enu> LocalPlane::enu_of(const LatLon& place) const {
  const GeographicLib::LocalCartesian local(origin_.latitude_deg, origin_.longitude_deg);
  Point2<Enu> point;
  double up = 0.0;
  local.Forward(place.latitude_deg, place.longitude_deg, 0.0, point.x_m, point.y_m, up);
  return point;
}

LatLon LocalPlane::place_of(const Point2<Enu>& point) const {
  const GeographicLib::LocalCartesian local(origin_.latitude_deg, origin_.longitude_deg);
  LatLon place;
  double height = 0.0;
  local.Reverse(point.x_m, point.y_m, 0.0, place.latitude_deg, place.longitude_deg, height);
  return place;
}

LatLon place_of(const GeoreferenceRecord& georeference, const Point2<Map>& point) {
  const Transform2<Enu, Map> enu_from_map(0.0, 0.0, to_rad(georeference.enu_from_map_yaw_deg));
  return LocalPlane({georeference.latitude_deg, georeference.longitude_deg}).place_of(enu_from_map * point);
}

GeoreferenceRecord rescaled(const GeoreferenceRecord& georeference, const Point2<Map>& held, double factor) {
  const double shrunk = 1.0 - factor;
  const LatLon origin = place_of(georeference, {held.x_m * shrunk, held.y_m * shrunk});
  return {origin.latitude_deg, origin.longitude_deg, georeference.enu_from_map_yaw_deg};
}

}  // namespace madori::mapping
