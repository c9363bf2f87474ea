#include "mapping/drawing/raster/stroke_width.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/drawing/raster/line_fit.hpp"

namespace madori::mapping {
namespace {

constexpr int kMostSamples = 15;
constexpr double kStep = 0.5;
constexpr double kThickest = 40;

double ink_reach(const GrayImage& ink, double u, double v, double du, double dv) {
  double reach = 0;
  while (reach < kThickest) {
    const int pu = static_cast<int>(std::floor(u + reach * du)),
              pv = static_cast<int>(std::floor(v + reach * dv));
    if (pu < 0 || pv < 0 || pu >= ink.width_px || pv >= ink.height_px || ink.at(pu, pv) == 0) break;
    reach += kStep;
  }
  return reach;
}

/// The mean without the widest and the narrowest fifth: crossings do not count, and a turned stroke, which
/// the grid makes now wider, now narrower, gets its true width.
double middle_mean(std::vector<double>& widths) {
  std::sort(widths.begin(), widths.end());
  const std::size_t cut = widths.size() / 5;
  double sum = 0;
  for (std::size_t i = cut; i < widths.size() - cut; ++i) sum += widths[i];
  return sum / static_cast<double>(widths.size() - 2 * cut);
}

}  // namespace

void measure_strokes(DrawnLines& lines, const GrayImage& ink) {
  std::vector<double> widths;
  for (DrawnLine& line : lines) {
    const FittedLine axis = line_through(line.segment);
    const int samples = std::clamp(static_cast<int>(line.length_px() / 3), 1, kMostSamples);
    widths.clear();
    for (int i = 0; i < samples; ++i) {
      const double t = (i + 0.5) / samples;
      const double u = std::lerp(line.segment.u1, line.segment.u2, t);
      const double v = std::lerp(line.segment.v1, line.segment.v2, t);
      const double du = -axis.direction_v, dv = axis.direction_u;
      widths.push_back(
          std::max(kStep, ink_reach(ink, u, v, du, dv) + ink_reach(ink, u, v, -du, -dv) - kStep));
    }
    line.stroke_px = middle_mean(widths);
  }
}

}  // namespace madori::mapping
