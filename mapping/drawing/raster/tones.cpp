#include "mapping/drawing/raster/tones.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <opencv2/core/utility.hpp>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr double kRareTone = 1e-4;  // of the pixels: dust and glare do not say what is black and what white
constexpr int kLeastRange = 20;     // grey levels: an empty sheet stays as it is
constexpr int kRowsAsked = 1000;    // rows that are enough to tell the ground
constexpr int kStepShare = 8;       // of the range: what steps less is shading
constexpr double kNoise = 0.5;      // of the pixels are steps: white noise has 0.77, dense hatching 0.3
constexpr std::size_t kAtOnce = 1 << 18;  // pixels that a thread counts: far more work than to start it

/// Steps from pixel to pixel, by the grey of the one that is no ground.
struct Steps {
  std::size_t darker = 0, brighter = 0;

  void count(std::span<const std::uint8_t> row, int ground, int range) {
    for (std::size_t u = 1; u < row.size(); ++u) {
      const int one = row[u - 1], other = row[u];
      if (kStepShare * std::abs(one - other) < range) continue;
      const int off = std::abs(one - ground) > std::abs(other - ground) ? one : other;
      ++(off < ground ? darker : brighter);
    }
  }
};

/// Of at least kRowsAsked rows of a drawing; throws Error where they are noise.
Steps steps_of(const GrayImage& image, int ground, int range) {
  const int apart = 1 + image.height_px / kRowsAsked, rows = (image.height_px + apart - 1) / apart;
  const auto width = static_cast<std::size_t>(image.width_px);
  Steps sum;
  std::mutex one_at_a_time;
  cv::parallel_for_({0, rows}, [&](const cv::Range& some) {
    Steps steps;
    for (int row = some.start; row < some.end; ++row)
      steps.count(std::span(image.pixels).subspan(static_cast<std::size_t>(row * apart) * width, width),
                  ground, range);
    const std::lock_guard lock(one_at_a_time);
    sum.darker += steps.darker, sum.brighter += steps.brighter;
  });
  const double pixels = static_cast<double>(width) * rows;
  if (static_cast<double>(sum.darker + sum.brighter) > kNoise * pixels)
    throw Error("wall detection", "the picture is noise, no line can be told in it",
                "scan it again, or smooth it first");
  return sum;
}

}  // namespace

ToneCounts tone_counts(std::span<const std::uint8_t> plane) {
  ToneCounts sum{};
  std::mutex one_at_a_time;
  const auto count = [&](const cv::Range& some) {
    // Four tables: neighbours of one paper do not wait for the same count.
    std::array<std::array<std::uint32_t, 256>, 4> tables{};
    const std::size_t from = static_cast<std::size_t>(some.start) * kAtOnce;
    const auto part =
        plane.subspan(from, std::min(plane.size(), static_cast<std::size_t>(some.end) * kAtOnce) - from);
    std::size_t i = 0;
    for (; i + tables.size() <= part.size(); i += tables.size())
      for (std::size_t k = 0; k < tables.size(); ++k) ++tables[k][part[i + k]];
    for (; i < part.size(); ++i) ++tables[0][part[i]];
    const std::lock_guard lock(one_at_a_time);
    for (const auto& table : tables)
      for (std::size_t tone = 0; tone < table.size(); ++tone) sum[tone] += table[tone];
  };
  cv::parallel_for_({0, static_cast<int>((plane.size() + kAtOnce - 1) / kAtOnce)}, count);
  return sum;
}

int commonest_tone(const ToneCounts& counts) {
  return static_cast<int>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

Tones tones_of(const GrayImage& image) {
  const ToneCounts counts = tone_counts(image.pixels);
  const auto left_out =
      static_cast<std::size_t>(std::floor(kRareTone * static_cast<double>(image.pixels.size())));
  std::size_t low = 0, high = counts.size() - 1, below = 0, above = 0;
  while ((below += counts[low]) <= left_out) ++low;
  while ((above += counts[high]) <= left_out) --high;
  const int range = static_cast<int>(high) - static_cast<int>(low);
  if (range < kLeastRange) return {};
  const Steps steps = steps_of(image, commonest_tone(counts), range);
  return {static_cast<double>(low), static_cast<double>(high), steps.brighter > steps.darker};
}

std::array<std::uint8_t, 256> spread(const Tones& tones) {
  std::array<std::uint8_t, 256> table{};
  for (int grey = 0; grey < 256; ++grey) {
    double share = std::clamp((grey - tones.darkest) / (tones.brightest - tones.darkest), 0.0, 1.0);
    if (tones.dark_ground) share = 1 - share;
    table[static_cast<std::size_t>(grey)] = static_cast<std::uint8_t>(std::lround(255 * share));
  }
  return table;
}

}  // namespace madori::mapping
