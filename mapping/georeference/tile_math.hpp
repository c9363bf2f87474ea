#pragma once

/// Web Mercator ("slippy map") tiles: the layout-map paper's Eq. (5), (6), (7) and their inverses.
/// Note on the paper: its worked example prints 35.464478 where the longitude 136.739235 belongs; the
/// results (230642.4, 103420.6) and 124.5 m are those of the longitude.
namespace madori::mapping {

inline constexpr int kMaxZoom = 30;
inline constexpr int kTilePixels = 256;
/// `L` of Eq. (6): where the square map ends.
inline constexpr double kMaxLatitudeDeg = 85.05112877980659;
/// Radius of Web Mercator's sphere, metres (WGS84's equator).
inline constexpr double kMercatorRadiusM = 6378137.0;

/// A place on Earth, WGS84 degrees.
struct LatLon {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// Tile coordinates with their fraction: tile (floor x, floor y), x to the east, y to the south.
struct TilePoint {
  double x = 0.0;
  double y = 0.0;
};

/// Where `place` lies at `zoom`. Throws Error beyond zoom 0..30, beyond the map's latitudes, or not finite.
[[nodiscard]] TilePoint tile_of(const LatLon& place, int zoom);
/// Eq. (5) and (6). Throws Error beyond zoom 0..30 or outside [0, 2^zoom].
[[nodiscard]] LatLon place_of(const TilePoint& tile, int zoom);

/// Length of a tile's side at a latitude on Web Mercator's sphere, metres; what Eq. (7) gives, without the
/// difference of two angles.
[[nodiscard]] double tile_side_m(double latitude_deg, int zoom);

/// A tile on the ellipsoid is no square: its sides to the east and to the north at a place, metres.
struct TileSides {
  double east_m = 0.0;
  double north_m = 0.0;
};
[[nodiscard]] TileSides ellipsoid_tile_sides(const LatLon& place, int zoom);

/// Shortest way on the WGS84 ellipsoid, metres (GeographicLib).
[[nodiscard]] double geodesic_m(const LatLon& a, const LatLon& b);

}  // namespace madori::mapping
