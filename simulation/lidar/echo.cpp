#include "simulation/lidar/echo.hpp"

namespace madori::simulation {
namespace {

constexpr float kSquareOnPane = 0.985F;  ///< within 10 deg
constexpr float kGrazing = 0.026F;       ///< 1.5 deg
constexpr std::uint32_t kLostBehindGlass = 65'536 / 12;

}  // namespace

Echoes echoes_of(const Hit& hit, const EchoOptions& options, std::uint64_t bits) {
  Echoes echoes;
  const auto dropped = static_cast<std::uint32_t>(options.dropout * 65'536.0);
  if (((bits >> 32U) & 0xFFFFU) < dropped) return echoes;
  const float noise = options.noise_m * normal_from_bits(static_cast<std::uint32_t>(bits));
  const auto echo = [&](float range, Material material) {
    const bool seen = range + noise >= options.range_min_m && range <= options.range_max_m;
    return seen ? Echo{range + noise, material} : Echo{};
  };
  const bool pane = hit.glass_m < hit.range_m;
  const bool lost_behind = pane && (bits >> 48U) < kLostBehindGlass;
  if (hit.range_m != Hit::kNothing && hit.incidence_cos > kGrazing && !lost_behind)
    echoes.last = echo(hit.range_m, hit.material);
  echoes.strongest = echoes.last;
  if (pane && hit.glass_cos > kSquareOnPane) {
    echoes.strongest = echo(hit.glass_m, Material::Glass);
    if (echoes.last.range_m == Hit::kNothing) echoes.last = echoes.strongest;
  }
  return echoes;
}

}  // namespace madori::simulation
