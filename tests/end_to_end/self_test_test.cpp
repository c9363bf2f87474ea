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
using testing::HasSubstr;
using testing::Not;

class SelfTestOfASite : public testing::Test {
 protected:
  /// The sample site with this lidar instead of its own.
  app::Finding floor_with(const std::string& lidar) {
    fs::copy(MADORI_SAMPLE_SITE, folder_.path(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    std::ifstream in(folder_.path() / "site.yaml");
    std::stringstream text;
    text << in.rdbuf();
    const std::string site = text.str();
    const auto at = site.find("sensors:"), end = site.find('\n', site.find("- {", at));
    folder_.write("site.yaml",
                  site.substr(0, at) + "sensors:\n  - {name: one, " + lidar + "}" + site.substr(end));
    for (const app::Finding& finding : app::look_at_site(folder_.path()).findings)
      if (finding.what == "floor") return finding;
    return {};
  }

 private:
  test::TemporaryFolder folder_;
};

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
