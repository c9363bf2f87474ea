// How many places of a site the survey finds, by the site's size and how far around is remembered; lines of
// CSV.
#include <chrono>
#include <cstdio>
#include <random>

#include "localization/placement/survey.hpp"
#include "localization/pose_axes.hpp"
#include "tests/support/tiled_floor.hpp"

namespace madori::localization {
namespace {

constexpr int kPlaces = 60;

void survey_site(int tiles, double sigma_m, double range_m) {
  std::mt19937 engine(7);
  const mapping::Walls walls = test::tiled_floor(tiles, engine);
  const WallIndex index(walls);
  std::uniform_real_distribution<double> x(3.0, 80.0 * tiles - 3.0), y(5.0, 50.0 * tiles - 5.0),
      turn(-kPi, kPi), shift(-60.0, 60.0);
  int first = 0, among = 0;
  double spent_ms = 0.0;
  for (int trial = 0; trial < kPlaces; ++trial) {
    const Transform2<Map, Base> place(x(engine), y(engine), turn(engine));
    const MemoryCloud seen = test::seen_from(place.translation(), walls, range_m, sigma_m, engine);
    const Transform2<Map, Map> elsewhere(shift(engine), shift(engine), turn(engine));
    const Transform2<Map, Base> at = elsewhere * place;
    const MemoryCloud cloud = moved(seen, elsewhere);
    const auto begun = std::chrono::steady_clock::now();
    const auto likeliest = survey(index, cloud, at, 30);
    spent_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    const auto right = [&](const auto& c) { return same_place(c * at, place, 0.9, to_rad(8.0)); };
    first += !likeliest.empty() && right(likeliest.front()) ? 1 : 0;
    among += std::ranges::any_of(likeliest, right) ? 1 : 0;
  }
  std::printf("%d,%d,%.2f,%.0f,%d,%d,%d,%.0f\n", 80 * tiles, 50 * tiles, sigma_m, range_m, kPlaces, first,
              among, spent_ms / kPlaces);
}

}  // namespace
}  // namespace madori::localization

int main() {
  std::puts("width_m,height_m,walls_off_m,range_m,places,first,of_thirty,ms");
  for (const int tiles : {1, 2, 3, 5})
    for (const double sigma_m : {0.03, 0.3})
      for (const double range_m : {12.0, 25.0}) madori::localization::survey_site(tiles, sigma_m, range_m);
}
