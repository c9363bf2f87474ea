#include "simulation/lidar/beam_spot.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace madori::simulation {
namespace {

constexpr double kAt = 0.85;          ///< of the radius: half the energy of an even beam lies outside 0.7
constexpr double kTurnedRad = 0.436;  ///< 25 deg
constexpr float kFlatM = 0.002F;

/// The rays that end on one side of an edge.
struct Side {
  float sum_m = 0.0F;
  float count = 0.0F;
  Hit hit;

  void add(const Hit& ray) {
    if (count == 0.0F) hit = ray;
    sum_m += ray.range_m;
    count += 1.0F;
  }
  /// One echo at the mean range.
  [[nodiscard]] Hit echo() const {
    Hit result = hit;
    if (count > 0.0F) result.range_m = sum_m / count;
    return result;
  }
};

struct Extent {
  float near_m = Hit::kNothing, far_m = 0.0F;
  float slant_m = kFlatM;  ///< how far apart two rays end on one surface that is not square on the beam
};

Extent extent_of(std::span<const Hit> rays, const BeamSpot& spot) {
  Extent e;
  for (const Hit& ray : rays) {
    if (ray.range_m == Hit::kNothing) continue;
    e.near_m = std::min(e.near_m, ray.range_m);
    e.far_m = std::max(e.far_m, ray.range_m);
    const float c = std::max(ray.incidence_cos, 1e-3F);
    const auto wide_m = static_cast<float>(spot.diameter_m(static_cast<double>(ray.range_m)));
    e.slant_m = std::max(e.slant_m, kFlatM + wide_m * std::sqrt(std::max(1.0F - c * c, 0.0F)) / c);
  }
  return e;
}

SpotHits all(const Hit& hit) {
  return {hit, hit, hit, false};
}

/// Most beams: all rays on one surface that is nearly square on them; nullopt for the others.
std::optional<Hit> on_one_surface(std::span<const Hit> rays) {
  Side side;
  float near_m = Hit::kNothing, far_m = 0.0F;
  for (const Hit& ray : rays) {
    near_m = std::min(near_m, ray.range_m), far_m = std::max(far_m, ray.range_m);
    side.add(ray);
  }
  if (far_m == Hit::kNothing || far_m - near_m > kFlatM) return std::nullopt;
  return side.echo();
}

}  // namespace

BeamSpot::BeamSpot(double beam_m, double spread_rad, std::size_t rays)
    : beam_m_(beam_m), spread_rad_(spread_rad) {
  const double a = kAt * std::cos(kTurnedRad), b = kAt * std::sin(kTurnedRad);
  if (beam_m + spread_rad <= 0.0 || rays < 2)
    rays_ = {Offset{}};
  else if (rays < 5)
    rays_ = {{a, b}, {-a, -b}};
  else
    rays_ = {Offset{}, {a, b}, {-a, -b}, {-b, a}, {b, -a}};
}

SpotHits meet(std::span<const Hit> rays, const BeamSpot& spot, float share) {
  if (rays.size() == 1) return all(rays[0]);
  if (const auto surface = on_one_surface(rays)) return all(*surface);
  const Extent extent = extent_of(rays, spot);
  const auto count = static_cast<float>(rays.size());
  const bool edge = extent.far_m - extent.near_m > extent.slant_m;
  const float between = edge ? (extent.near_m + extent.far_m) / 2.0F : extent.far_m;
  Side near, far;
  for (const Hit& ray : rays)
    if (ray.range_m != Hit::kNothing) (ray.range_m <= between ? near : far).add(ray);
  Hit nothing;  // but for a pane that the beam goes through
  nothing.glass_m = rays[0].glass_m, nothing.glass_cos = rays[0].glass_cos;
  if (near.count == 0.0F) return all(nothing);
  const float of_near = near.count == count ? 1.0F : (near.count - 0.5F + share) / count;
  if (!edge) return all(of_near >= kLeastShare ? near.echo() : nothing);
  const float of_far = (1.0F - of_near) * far.count / (count - near.count);
  Hit a = near.echo();
  const Hit b = far.echo();
  if (b.range_m - a.range_m < kPulseM) {
    const float w = of_near / (of_near + of_far);
    a.range_m = w * a.range_m + (1.0F - w) * b.range_m;
    return all(a);
  }
  if (std::max(of_near, of_far) < kLeastShare) return all(nothing);
  const Hit& first = of_near >= kLeastShare ? a : b;
  const Hit& last = of_far >= kLeastShare ? b : a;
  return {first, last, of_near >= of_far ? a : b, true};
}

}  // namespace madori::simulation
