#include "mapping/georeference/tile_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "mapping/georeference/scale_estimate.hpp"

namespace madori::mapping {
namespace {

constexpr LatLon kGifu{35.464478, 136.739235};
constexpr double kPaperRadiusM = 6378130.0;  ///< `r` of Eq. (7)

/// Eq. (7): a sphere, up to 0.5 % off.
double spherical_m(const LatLon& a, const LatLon& b) {
  const double f1 = to_rad(a.latitude_deg);
  const double f2 = to_rad(b.latitude_deg);
  const double cosine = std::sin(f1) * std::sin(f2) +
                        std::cos(f1) * std::cos(f2) * std::cos(to_rad(b.longitude_deg - a.longitude_deg));
  return kPaperRadiusM * std::acos(std::clamp(cosine, -1.0, 1.0));
}

TEST(TileMath, HoldsThePublishedExample) {
  const TilePoint tile = tile_of(kGifu, 18);
  // Eq. (5) gives 230642.472; the paper prints it cut to one digit.
  EXPECT_EQ(std::floor(tile.x * 10.0) / 10.0, 230642.4);
  EXPECT_EQ(std::floor(tile.y * 1000.0) / 1000.0, 103420.595);  // cut likewise
  EXPECT_NEAR(tile_side_m(kGifu.latitude_deg, 18), 124.5, 0.05);
  const double eq7 = spherical_m(place_of({230643, 103420}, 18), place_of({230643, 103421}, 18));
  EXPECT_NEAR(eq7, 124.5, 0.05);
}

TEST(TileMath, HoldsThePublishedScale) {
  const double u = overlay_scale(124.5, kTilePixels, 1.67, 3.3);
  EXPECT_NEAR(u, 0.9610, 5e-5);
  EXPECT_NEAR(u * 72.4, 69.6, 0.05);
}

TEST(TileMath, HoldsKnownTiles) {
  const LatLon japan = place_of({14622, 6017}, 14);
  EXPECT_NEAR(japan.latitude_deg, 43.05283, 5e-6);
  EXPECT_NEAR(japan.longitude_deg, 141.28418, 5e-6);
  EXPECT_NEAR(tile_side_m(japan.latitude_deg, 14) / kTilePixels, 6.982, 5e-4);
  const LatLon berlin = place_of({70420, 42997}, 17);
  EXPECT_NEAR(berlin.latitude_deg, 52.501176, 5e-7);
  EXPECT_NEAR(berlin.longitude_deg, 13.414307, 5e-7);
  // 0.72704 at the corner and 0.72706 in the middle of the tile: 0.7271 is the figure of the tile.
  const LatLon middle = place_of({70420.5, 42997.5}, 17);
  EXPECT_NEAR(tile_side_m(berlin.latitude_deg, 17) / kTilePixels, 0.7271, 1e-4);
  EXPECT_NEAR(tile_side_m(middle.latitude_deg, 17) / kTilePixels, 0.7271, 5e-5);
}

TEST(TileMath, ComesBackToThePixelAtZoom20) {
  double worst_px = 0.0;
  for (double latitude = -85.0; latitude <= 85.0; latitude += 0.0371)
    for (double longitude = -180.0; longitude <= 180.0; longitude += 7.31) {
      const TilePoint tile = tile_of({latitude, longitude}, 20);
      const TilePoint back = tile_of(place_of(tile, 20), 20);
      worst_px = std::max(worst_px, kTilePixels * std::hypot(back.x - tile.x, back.y - tile.y));
    }
  RecordProperty("worst_px", std::to_string(worst_px * 1e9) + "e-9");
  EXPECT_LT(worst_px, 1e-6);
}

TEST(TileMath, TheEllipsoidIsNotTheSphere) {
  // Radii of curvature of WGS84 at 35.46 degrees: the tile is 0.1 % wider and 0.3 % lower than the sphere's.
  const TileSides sides = ellipsoid_tile_sides(kGifu, 18);
  EXPECT_NEAR(sides.east_m, 124.6525, 1e-3);
  EXPECT_NEAR(sides.north_m, 124.0977, 1e-3);
  EXPECT_NEAR(geodesic_m({0.0, 0.0}, {0.0, 90.0}), 6378137.0 * std::acos(0.0), 1e-3);
}

TEST(TileMath, RefusesWhatIsNoPlace) {
  EXPECT_THROW((void)tile_of({86.0, 0.0}, 3), Error);
  EXPECT_THROW((void)tile_of({0.0, std::nan("")}, 3), Error);
  EXPECT_THROW((void)tile_of({0.0, 0.0}, 31), Error);
  EXPECT_THROW((void)tile_of({0.0, 0.0}, -1), Error);
  EXPECT_THROW((void)place_of({9.0, 0.0}, 3), Error);
}

}  // namespace
}  // namespace madori::mapping
