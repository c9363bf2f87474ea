#include "mapping/drawing/raster/skew.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace madori::mapping {
namespace {

constexpr int kBins = 900;
constexpr double kBin = 90.0 / kBins;   // degrees
constexpr int kPeakReach = 5;           // bins to either side of the peak that share in the mean
constexpr double kLargestShift = 0.75;  // pixels at the end of a wall
constexpr double kDegree = std::numbers::pi / 180;

/// Counter-clockwise, modulo 90 degrees, [0, 90).
double quarter_angle_deg(const PixelSegment& s) {
  const double angle = std::atan2(-(s.v2 - s.v1), s.u2 - s.u1) / kDegree;
  return angle - 90 * std::floor(angle / 90);
}

}  // namespace

double measure_skew_deg(const std::vector<PixelSegment>& walls) {
  std::vector<double> lengths(kBins, 0);
  for (const PixelSegment& s : walls)
    lengths[static_cast<std::size_t>(quarter_angle_deg(s) / kBin) % kBins] += s.length_px();
  const auto around = [&](int bin) {
    double sum = 0;
    for (int k = -kPeakReach; k <= kPeakReach; ++k)
      sum += lengths[static_cast<std::size_t>((bin + k + kBins) % kBins)];
    return sum;
  };
  int peak = 0;
  for (int bin = 1; bin < kBins; ++bin)
    if (around(bin) > around(peak)) peak = bin;
  double weighted = 0, total = 0;
  for (const PixelSegment& s : walls) {
    const double off = std::remainder(quarter_angle_deg(s) - (peak + 0.5) * kBin, 90);
    if (std::abs(off) > (kPeakReach + 0.5) * kBin) continue;
    weighted += off * s.length_px() * s.length_px();  // the direction of a long wall is the better known
    total += s.length_px() * s.length_px();
  }
  if (total <= 0) return 0;
  const double skew = std::remainder((peak + 0.5) * kBin + weighted / total, 90);
  return skew <= -45 ? skew + 90 : skew;
}

void straighten(std::vector<PixelSegment>& walls, double skew_deg) {
  for (PixelSegment& s : walls) {
    const double off = std::remainder(quarter_angle_deg(s) - skew_deg, 90) * kDegree;
    if (std::abs(off) * 0.5 * s.length_px() > kLargestShift || std::abs(off) > 0.1) continue;
    const double mu = 0.5 * (s.u1 + s.u2), mv = 0.5 * (s.v1 + s.v2);
    const double du = 0.5 * (s.u2 - s.u1), dv = 0.5 * (s.v2 - s.v1);
    const double c = std::cos(off), q = std::sin(off);  // clockwise by `off`, in pixels with v down
    const double tu = c * du - q * dv, tv = q * du + c * dv;
    s = {mu - tu, mv - tv, mu + tu, mv + tv};
  }
}

}  // namespace madori::mapping
