// What `madori doctor` says of a site before it is driven, for lidars at several heights.
#include "app/runner/self_test.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/support/temporary_folder.hpp"

namespace madori {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class SelfTestOfASite : public testing::Test {
 protected:
  app::Finding floor_with(const std::string& lidar) { return finding_with(lidar, "floor"); }
  /// Of the sample site with this lidar instead of its own, and a vehicle so wide.
  app::Finding finding_with(const std::string& lidar, const std::string& what,
                            const std::string& width_m = "0.6") {
    fs::copy(MADORI_SAMPLE_SITE, folder_.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    std::ifstream in(folder_.path() / "site.yaml");
    std::stringstream text;
    text << in.rdbuf();
    std::string site = text.str();
    const auto width = site.find("  width_m: ");
    site.replace(width, site.find('\n', width) - width, "  width_m: " + width_m);
    const auto at = site.find("sensors:"), end = site.find('\n', site.find("- {", at));
    folder_.write("site.yaml",
                  site.substr(0, at) + "sensors:\n  - {name: one, " + lidar + "}" + site.substr(end));
    for (const app::Finding& finding : app::look_at_site(folder_.path()).findings)
      if (finding.what == what) return finding;
    return {};
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(SelfTestOfASite, ALegNarrowerThanTheVehicleIsTold) {
  EXPECT_THAT(finding_with("type: vlp16, x_m: 0.3, z_m: 1.2", "routes").text, EndsWith("can be reached"));
  const auto routes = finding_with("type: vlp16, x_m: 0.3, z_m: 1.2", "routes", "2.6");
  EXPECT_FALSE(routes.missing) << routes.text;
  EXPECT_THAT(routes.text, HasSubstr("of madori route --check, the first: "));
  EXPECT_THAT(routes.text, HasSubstr("less than half the vehicle's width of 1.30 m"));
}

TEST_F(SelfTestOfASite, AVlp16OnTheVehicleSeesWhoLiesAndWhoStands) {
  const auto floor = floor_with("type: vlp16, x_m: 0.3, z_m: 1.2");
  EXPECT_FALSE(floor.missing) << floor.text;
  EXPECT_THAT(floor.text, HasSubstr("is sure to 3.2 m"));
  EXPECT_THAT(floor.text, Not(HasSubstr("looked over")));
}

TEST_F(SelfTestOfASite, AVlp16OnAMastLooksOverWhoStandsNear) {
  const auto floor = floor_with("type: vlp16, x_m: 0.3, z_m: 2.2");
  EXPECT_FALSE(floor.missing) << floor.text;  // (2.2 m - 1.5 m) / tan(15 deg) - 0.5 m
  EXPECT_THAT(floor.text, HasSubstr("a person who stands within 2.1 m of the front is looked over"));
}

TEST_F(SelfTestOfASite, APlanarLidarThatLooksOverWhoLiesIsToldToHangLower) {
  const auto floor = floor_with("type: lms1xx, x_m: 0.75, z_m: 0.25");
  EXPECT_TRUE(floor.missing);
  EXPECT_THAT(floor.text, HasSubstr("mount a lidar at 0.2 m or lower"));
  EXPECT_FALSE(floor_with("type: lms1xx, x_m: 0.75, z_m: 0.18").missing);
}

}  // namespace
}  // namespace madori
