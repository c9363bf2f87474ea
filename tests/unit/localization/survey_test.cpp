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
  std::uniform_real_distribution<double> x(3.0, 80.0 * tiles - 3.0), y(5.0, 50.0 * tiles - 5.0),
      turn(-kPi, kPi), shift(-60.0, 60.0);
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Transform2<Map, Base> place(x(engine), y(engine), turn(engine));
    const MemoryCloud seen = test::seen_from(place.translation(), walls, 12.0, sigma_m, engine);
    const Transform2<Map, Map> elsewhere(shift(engine), shift(engine), turn(engine));
    const Transform2<Map, Base> at = elsewhere * place;
    const auto likeliest = survey(index, moved(seen, elsewhere), at, 30);
    EXPECT_LE(likeliest.size(), 30U);
    for (std::size_t i = 0; i < likeliest.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_FALSE(same_place(likeliest[i] * at, likeliest[k] * at, 0.9, to_rad(10.0)));
    found += std::ranges::any_of(likeliest,
                                 [&](const auto& c) { return same_place(c * at, place, 0.9, to_rad(8.0)); });
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
