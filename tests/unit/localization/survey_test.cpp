#include "localization/placement/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "localization/pose_axes.hpp"
#include "tests/support/tiled_floor.hpp"

namespace madori::localization {
namespace {

/// Of 20 places of the site, how many are among the thirty likeliest, wherever the memory began and however
/// it is turned.
int places_found(const mapping::Walls& walls, int tiles, double sigma_m, std::mt19937& engine) {
  const WallIndex index(walls);
  test::SurveyedPlaces places(walls, tiles, 12.0, sigma_m);
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto here = places.next(engine);
    const auto likeliest = survey(index, here.cloud, here.at, 30);
    EXPECT_LE(likeliest.size(), 30U);
    for (std::size_t i = 0; i < likeliest.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_FALSE(same_place(likeliest[i] * here.at, likeliest[k] * here.at, 0.9, to_rad(10.0)));
    found += std::ranges::any_of(likeliest, [&](const auto& c) { return here.is_there(c); });
  }
  return found;
}

TEST(Survey, EveryPlaceOfAFloorIsFound) {
  std::mt19937 engine(4);
  EXPECT_EQ(places_found(test::tiled_floor(1, engine), 1, 0.03, engine), 20);
}

/// 240 m x 150 m, walls 0.3 m beside where they are drawn, seen 12 m around: with the same blur at every
/// width of the grid a third were found.
TEST(Survey, SoAreThoseOfAFloorNineTimesAsLarge) {
  std::mt19937 engine(5);
  EXPECT_GE(places_found(test::tiled_floor(3, engine), 3, 0.3, engine), 19);
}

TEST(Survey, OfNoDrawingNothingIsFound) {
  EXPECT_TRUE(survey(WallIndex(mapping::Walls{}), {}, {}, 30).empty());
}

}  // namespace
}  // namespace madori::localization
