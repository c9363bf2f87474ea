#include "mapping/drawing/raster/edge_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace madori::mapping {
namespace {

constexpr float kLeastContrast = 25;  // grey levels
constexpr double kWidthDiffers = 1.2, kWidthDiffersShare = 0.35;

/// Between two neighbouring samples, where the darkness passes the level.
double crossing_px(const EdgeProfile& profile, std::size_t i, float level) {
  const float a = profile.darkness[i], b = profile.darkness[i + 1];
  return profile.at_px(i) + profile.step_px * static_cast<double>((level - a) / (b - a));
}

/// From the sample `peak` in steps of `sense`, where the darkness has fallen half way to the palest of that
/// side.
std::optional<double> flank_px(const EdgeProfile& profile, std::size_t peak, int sense) {
  const auto& dark = profile.darkness;
  const auto first = dark.begin(), top = first + static_cast<std::ptrdiff_t>(peak);
  const float palest = sense < 0 ? *std::min_element(first, top + 1) : *std::min_element(top, dark.end());
  if (dark[peak] - palest < kLeastContrast) return std::nullopt;
  const float level = 0.5F * (dark[peak] + palest);
  for (auto i = static_cast<std::ptrdiff_t>(peak); i > 0 && i + 1 < std::ssize(dark); i += sense) {
    const auto lower = static_cast<std::size_t>(sense < 0 ? i - 1 : i);
    if ((dark[lower] > level) != (dark[lower + 1] > level)) return crossing_px(profile, lower, level);
  }
  return std::nullopt;
}

}  // namespace

std::optional<EdgePlace> face_place(const EdgeProfile& profile, double reach_px) {
  const auto& dark = profile.darkness;
  if (dark.size() < 3) return std::nullopt;
  const auto [palest, darkest] = std::minmax_element(dark.begin(), dark.end());
  if (*darkest - *palest < kLeastContrast) return std::nullopt;
  const float level = 0.5F * (*palest + *darkest);
  std::optional<EdgePlace> nearest;
  for (std::size_t i = 0; i + 1 < dark.size(); ++i) {
    if ((dark[i] > level) == (dark[i + 1] > level)) continue;
    const double at = crossing_px(profile, i, level);
    if (std::abs(at) > reach_px || (nearest && std::abs(at) >= std::abs(nearest->offset_px))) continue;
    nearest = EdgePlace{at, dark[i + 1] > dark[i]};
  }
  return nearest;
}

std::optional<EdgePlace> stroke_place(const EdgeProfile& profile, double reach_px, double stroke_px) {
  std::optional<std::size_t> peak;
  for (std::size_t i = 0; i < profile.darkness.size(); ++i) {
    if (std::abs(profile.at_px(i)) > reach_px) continue;
    if (!peak || profile.darkness[i] > profile.darkness[*peak]) peak = i;
  }
  if (!peak) return std::nullopt;
  const auto low = flank_px(profile, *peak, -1), high = flank_px(profile, *peak, 1);
  if (!low || !high) return std::nullopt;
  const double width = *high - *low, middle = 0.5 * (*low + *high);
  if (std::abs(width - stroke_px) > kWidthDiffers + kWidthDiffersShare * stroke_px) return std::nullopt;
  if (std::abs(middle) > reach_px) return std::nullopt;
  return EdgePlace{middle, false};
}

}  // namespace madori::mapping
