// A new revision of a site's drawing takes the old one's place.
#include "app/revision/carry_site.hpp"

#include <gtest/gtest.h>

#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/site_versions.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

class CarrySite : public testing::Test {
 protected:
  /// A site without pictures.
  std::filesystem::path made(const std::string& name, double m_per_px, const mapping::Walls& walls) {
    const auto folder = folder_.path() / name;
    mapping::Site site;
    site.name = name;
    site.drawing = {"drawing.png", 1000, 500, 1, 0.0};
    if (m_per_px > 0.0) site.scale = mapping::ScaleRecord{m_per_px, "dxf-units", 0.0, 0.0, "", {}};
    mapping::SiteTransaction change(folder);
    change.write("site.yaml", mapping::site_yaml(site));
    change.write("walls.csv", mapping::walls_csv(walls));
    for (const char* file : {"drawing.png", "import.png", mapping::kWayFile}) change.write(file, name);
    change.commit();
    return folder;
  }
  test::TemporaryFolder folder_;
  const mapping::Walls pixels_{{1, {{100, 100}, {900, 100}}, 0.75}, {2, {{100, 400}, {900, 400}}, 1.0}};
  const mapping::Walls metres_{{1, {{2, 2}, {18, 2}}}, {2, {{2, 8}, {18, 8}}}};
};

TEST_F(CarrySite, ADrawingThatKnowsItsSizeMeasuresASiteThatDidNot) {
  const auto site = made("site", 0.0, pixels_), beside = made("beside", 0.02, metres_);
  carry_site(site, beside, {50.0, 0.0, {0.0, 0.0}}, pixels_);
  const mapping::Site now = mapping::load_scaled_site(site);
  EXPECT_EQ(now.scale->m_per_px, 0.02);
  EXPECT_EQ(now.name, "site");
  const mapping::Walls walls = mapping::load_walls(site / "walls.csv");
  ASSERT_EQ(walls.size(), 2U);
  EXPECT_NEAR(walls[0].segment.b.x_m, 18.0, 1e-9);
  EXPECT_NEAR(walls[1].segment.a.y_m, 8.0, 1e-9);
}

TEST_F(CarrySite, AMeasuredSiteKeepsItsScaleAndHowProbableItsWallsAre) {
  const auto site = made("site", 0.02, metres_), beside = made("beside", 0.0, pixels_);
  mapping::Walls walls = metres_;
  walls[0].probability = 0.75;
  carry_site(site, beside, {0.021, 0.0, {0.0, 0.0}}, walls);
  EXPECT_NEAR(mapping::load_scaled_site(site).scale->m_per_px, 0.021, 1e-12);
  const mapping::Walls now = mapping::load_walls(site / "walls.csv");
  ASSERT_EQ(now.size(), 2U);
  EXPECT_NEAR(now[0].segment.b.x_m, 18.0, 1e-6);
  EXPECT_EQ(now[0].probability, 0.75);
}

TEST_F(CarrySite, TheWayThatWasDrivenOnTheOldDrawingGoes) {
  const auto site = made("site", 0.02, metres_), beside = made("beside", 0.0, pixels_);
  carry_site(site, beside, {0.02, 0.0, {1.0, 0.0}}, metres_);
  EXPECT_FALSE(std::filesystem::exists(site / mapping::kWayFile));
}

}  // namespace
}  // namespace madori::app
