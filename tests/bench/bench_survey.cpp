// How many places of a site the survey finds, by the site's size and how far around is remembered; lines of
// CSV.
#include <chrono>
#include <cstdio>
#include <random>

#include "localization/placement/survey.hpp"
#include "tests/support/tiled_floor.hpp"

namespace madori::localization {
namespace {

constexpr int kPlaces = 60;

void survey_site(int tiles, double sigma_m, double range_m) {
  std::mt19937 engine(7);
  const mapping::Walls walls = test::tiled_floor(tiles, engine);
  const WallIndex index(walls);
  test::SurveyedPlaces places(walls, tiles, range_m, sigma_m);
  int first = 0, among = 0;
  double spent_ms = 0.0;
  for (int trial = 0; trial < kPlaces; ++trial) {
    const auto here = places.next(engine);
    const auto begun = std::chrono::steady_clock::now();
    const auto likeliest = survey(index, here.cloud, here.at, 30);
    spent_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    const auto right = [&](const auto& c) { return here.is_there(c); };
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
