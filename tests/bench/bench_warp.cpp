// How well the warp is found from a lap of 100 m in bent buildings: bench_warp AMPLITUDE_M FIRST_SEED
// LAST_SEED
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "localization/warp/warp_fit.hpp"
#include "tests/support/bent_memory.hpp"

namespace {

double processor_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0
                        : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

int main(int count, char** arguments) {
  using namespace madori;
  if (count != 4) {
    std::fputs("bench_warp AMPLITUDE_M FIRST_SEED LAST_SEED\n", stderr);
    return 2;
  }
  const double amplitude = std::atof(arguments[1]);
  std::vector<double> all;
  std::puts("seed,kind,median_m,p95_m,sigma_m,nats,again_ms");
  for (int seed = std::atoi(arguments[2]); seed <= std::atoi(arguments[3]); ++seed) {
    const auto made = test::bent_building(test::hard_building(static_cast<std::uint32_t>(seed), amplitude));
    test::BentMemoryOptions options;
    options.clutter = 0.05;
    const auto cloud = localization::memory_cloud(test::bent_memory(made, options));
    const localization::WallIndex index(made.drawn);
    const auto grown = localization::fit_warp_from_start(index, cloud);
    const double start = processor_s();
    const auto fit = localization::fit_warp(index, cloud, grown.next);
    const double again_ms = 1e3 * (processor_s() - start);
    std::vector<double> errors;
    std::vector<double> sigmas;
    for (const Point2<Map>& p : test::along_lap(made, 0.8, options.metres)) {
      errors.push_back(distance_m(fit.warp.map(made.warp->building(p)), p));
      sigmas.push_back(fit.warp.sigma_m(p));
    }
    all.insert(all.end(), errors.begin(), errors.end());
    std::printf("%d,%d,%.3f,%.3f,%.3f,%.1f,%.0f\n", seed, static_cast<int>(made.options.kind),
                quantile(errors, 0.5), quantile(errors, 0.95), quantile(sigmas, 0.5), fit.evidence_nats,
                again_ms);
    std::fflush(stdout);
  }
  std::printf("all,,%.3f,%.3f\n", quantile(all, 0.5), quantile(all, 0.95));
}
