#include "mapping/georeference/tile_math.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::mapping {
namespace {

void check_zoom(int zoom) {
  if (zoom < 0 || zoom > kMaxZoom)
    throw Error("zoom " + std::to_string(zoom), "is no zoom level", "use 0 to " + std::to_string(kMaxZoom));
}

void check_place(const LatLon& place) {
  if (!(std::abs(place.latitude_deg) <= kMaxLatitudeDeg) || !(std::abs(place.longitude_deg) <= 180.0))
    throw Error(std::to_string(place.latitude_deg) + "," + std::to_string(place.longitude_deg),
                "is no place on the tile map",
                "give degrees: latitude within 85.05 of the equator, longitude within 180");
}

}  // namespace

TilePoint tile_of(const LatLon& place, int zoom) {
  check_zoom(zoom);
  check_place(place);
  const double half = std::ldexp(1.0, zoom - 1);
  // asinh(tan) equals the paper's atanh(sin), and keeps its digits near the poles.
  const double y = std::asinh(std::tan(to_rad(place.latitude_deg)));
  return {half * (place.longitude_deg / 180.0 + 1.0), half * (1.0 - y / kPi)};
}

LatLon place_of(const TilePoint& tile, int zoom) {
  check_zoom(zoom);
  const double half = std::ldexp(1.0, zoom - 1);
  if (!(tile.x >= 0.0 && tile.y >= 0.0 && tile.x <= 2.0 * half && tile.y <= 2.0 * half))
    throw Error("tile " + std::to_string(tile.x) + "," + std::to_string(tile.y),
                "is outside the map at zoom " + std::to_string(zoom), "check zoom and tile numbers");
  return {to_deg(std::atan(std::sinh(kPi * (1.0 - tile.y / half)))), 180.0 * (tile.x / half - 1.0)};
}

double tile_side_m(double latitude_deg, int zoom) {
  check_zoom(zoom);
  check_place({latitude_deg, 0.0});
  return std::ldexp(2.0 * kPi * kMercatorRadiusM * std::cos(to_rad(latitude_deg)), -zoom);
}

TileSides ellipsoid_tile_sides(const LatLon& place, int zoom) {
  const TilePoint at = tile_of(place, zoom);
  // A small step around the place, so that the sides are those at the place and not of a whole tile.
  const double size = std::ldexp(1.0, zoom);
  const double step = std::min({1e-3 * size, 0.5, at.y, size - at.y});
  const double x = std::clamp(at.x, step, size - step);
  const LatLon north = place_of({x, at.y - step}, zoom);
  const LatLon south = place_of({x, at.y + step}, zoom);
  const LatLon west = place_of({x - step, at.y}, zoom);
  const LatLon east = place_of({x + step, at.y}, zoom);
  return {geodesic_m(west, east) / (2.0 * step), geodesic_m(north, south) / (2.0 * step)};
}

double geodesic_m(const LatLon& a, const LatLon& b) {
  double distance = 0.0;
  GeographicLib::Geodesic::WGS84().Inverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg,
                                           distance);
  return distance;
}

}  // namespace madori::mapping
