#include "simulation/lidar/echo.hpp"

#include <algorithm>

namespace madori::simulation {
namespace {

constexpr float kSquareOnPane = 0.985F;  ///< within 10 deg
constexpr float kGrazing = 0.026F;       ///< 1.5 deg
constexpr std::uint32_t kLostBehindGlass = 65'536 / 12;

/// Which part of a beam is looked at, and how it is heard.
struct Listener {
  const EchoOptions& options;
  const RangeBias& bias;
  float angle_rad;
  float noise_m;
  bool lost_behind_glass;

  [[nodiscard]] Echo of(float range_m, Material material) const {
    const float heard_m = range_m + noise_m + bias.at(range_m, angle_rad, material);
    const bool seen = heard_m >= options.range_min_m && range_m <= options.range_max_m;
    return seen ? Echo{heard_m, material} : Echo{};
  }
  /// Of the surface behind a pane, where there is one.
  [[nodiscard]] Echo behind(const Hit& hit) const {
    const bool pane = hit.glass_m < hit.range_m;
    const bool heard = hit.range_m != Hit::kNothing && hit.incidence_cos > kGrazing;
    return heard && !(pane && lost_behind_glass) ? of(hit.range_m, hit.material) : Echo{};
  }
  [[nodiscard]] Echo nearest(const Hit& hit) const {
    const bool pane = hit.glass_m < hit.range_m && hit.glass_cos > kSquareOnPane;
    return pane ? of(hit.glass_m, Material::Glass) : behind(hit);
  }
};

}  // namespace

Echoes echoes_of(const SpotHits& hits, const EchoOptions& options, const RangeBias& bias, float angle_rad,
                 Random& random) {
  const std::uint64_t bits = random.next();
  const auto dropped = static_cast<std::uint32_t>(options.dropout * 65'536.0);
  if (((bits >> 32U) & 0xFFFFU) < dropped) return {};
  const Listener listener{options, bias, angle_rad,
                          options.noise_m * normal_from_bits(static_cast<std::uint32_t>(bits)),
                          (bits >> 48U) < kLostBehindGlass};
  Echoes echoes;
  echoes.first = echoes.strongest = listener.nearest(hits.first);
  if (hits.parted) echoes.strongest = listener.nearest(hits.strongest);
  echoes.last =
      hits.parted || hits.last.glass_m < hits.last.range_m ? listener.behind(hits.last) : echoes.first;
  if (echoes.last.range_m == Hit::kNothing) echoes.last = echoes.strongest;
  if (options.rain > 0.0 && random.uniform() < options.rain) {
    const float reach_m = std::min(hits.first.range_m, options.range_max_m);
    const Echo drop{
        static_cast<float>(random.uniform(options.range_min_m, std::max(reach_m, options.range_min_m))),
        Material::Cloth};
    echoes.first = echoes.strongest = drop;
  }
  return echoes;
}

}  // namespace madori::simulation
