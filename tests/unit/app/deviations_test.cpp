#include "app/learned/deviations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/made_up_buildings.hpp"

namespace madori::app {
namespace {

/// Of four walls: one as drawn, one 0.2 m to its right, one seen a little beside, one not seen.
struct Case {
  mapping::Walls walls;
  localization::WarpFit fit;
};

Case four_walls() {
  Case made;
  for (int i = 0; i < 4; ++i) test::add_wall(made.walls, 0.0, 3.0 * i, 5.0, 3.0 * i);
  made.fit.warp = localization::DrawingWarp({}, {}, {0.2, 15.0, 0.05, 0.02, 0.7});
  const localization::WallSide none{0.0, 0.05, 0.0, 0.0};
  made.fit.walls = {{{{{0.005, 0.02, 4.0, 1.0}, none}}},
                    {{{{-0.2, 0.02, 4.0, 1.0}, none}}},
                    {{{{0.03, 0.02, 4.0, 1.0}, none}}},
                    {{{none, none}}}};
  return made;
}

TEST(Deviations, TellWallByWallWhatIsSure) {
  const Case made = four_walls();
  const std::vector<Deviation> rows = deviations(made.walls, made.fit);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].standing, Standing::AsDrawn);
  EXPECT_EQ(rows[1].standing, Standing::Displaced);
  EXPECT_NEAR(rows[1].across_m, -0.2, 1e-12);
  EXPECT_NEAR(rows[1].stands.a.y_m, 2.8, 1e-12);
  EXPECT_EQ(rows[2].standing, Standing::AsDrawn) << "0.03 m is within two sigmas of 0.024 m";
  EXPECT_EQ(rows[3].standing, Standing::Unseen);
  EXPECT_GT(rows[3].sigma_m, 0.2) << "as far as drawings are wrong where nothing was seen";
}

TEST(Deviations, TheWarpMovesAWallToo) {
  Case made = four_walls();
  made.fit.warp = localization::DrawingWarp({1.0, 0.0, 0.1, 0.3}, {}, {0.2, 15.0, 0.05, 0.02, 0.7});
  const std::vector<Deviation> rows = deviations(made.walls, made.fit);
  EXPECT_NEAR(rows[1].across_m, 0.1, 1e-12);
  EXPECT_NEAR(rows[1].own_m, -0.2, 1e-12);
  EXPECT_NEAR(rows[1].stands.a.x_m, 0.1, 1e-12);
}

TEST(Deviations, AreWrittenAsTablePictureAndGeoJson) {
  const Case made = four_walls();
  const std::vector<Deviation> rows = deviations(made.walls, made.fit);
  const std::string csv = deviations_csv(rows);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(csv.find("-0.2000,-0.2000,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",displaced\n"), std::string::npos);
  EXPECT_GT(deviations_plot(made.walls, rows).size(), 2000U);
  mapping::Site site;
  site.name = "four";
  const auto plain = nlohmann::json::parse(deviations_geojson(site, rows));
  EXPECT_TRUE(plain.contains("coordinates_are"));
  EXPECT_NEAR(plain["features"][1]["geometry"]["coordinates"][0][1].get<double>(), 2.8, 1e-9);
  site.georeference = mapping::GeoreferenceRecord{};
  const auto placed = nlohmann::json::parse(deviations_geojson(site, rows));
  EXPECT_FALSE(placed.contains("coordinates_are"));
  EXPECT_EQ(placed["features"].size(), 4U);
  EXPECT_EQ(placed["features"][1]["properties"]["standing"], "displaced");
}

}  // namespace
}  // namespace madori::app
