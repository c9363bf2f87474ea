#include "mapping/drawing/raster/refine_lines.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_picture.hpp"

namespace madori::mapping {
namespace {

constexpr double kCorridor = 1.5;  // half width, pixels
constexpr double kExplained = 0.8;
constexpr int kMostRounds = 16;
constexpr double kLeastConnected = 0.8;  // share of a line's pixels that touch their predecessor
constexpr double kLargestBow = 0.5;      // pixels between the thirds; a straight line of a scan stays below
constexpr double kBowShare = 0.0015;     // ... and paper is allowed to warp

class Follower {
 public:
  Follower(GrayImage& lines, const RefineOptions& options) : lines_(lines), options_(options) {}

  std::optional<DrawnLine> follow(const PixelSegment& seed) {
    if (is_explained(seed)) return std::nullopt;
    FittedLine line = line_through(seed);
    double from = line.along(seed.u1, seed.v1), to = line.along(seed.u2, seed.v2);
    if (from > to) std::swap(from, to);
    for (int round = 0; round < kMostRounds; ++round) {
      const double reach = to - from;  // trust a direction no further than twice its base
      const FittedLine before = line;
      collect(line, from, to, reach);
      if (pixels_.size() < 3) return std::nullopt;
      line = fit_line(pixels_);
      if (line.direction_u * before.direction_u + line.direction_v * before.direction_v < 0) line.reverse();
      from = line.along(pixels_.front().u, pixels_.front().v);
      to = line.along(pixels_.back().u, pixels_.back().v);
      if (from > to) std::swap(from, to);
      if (to - from < reach + 1) break;
    }
    return accept(line, from, to);
  }

 private:
  [[nodiscard]] std::uint8_t at(int u, int v) const {
    return u < 0 || v < 0 || u >= lines_.width_px || v >= lines_.height_px ? std::uint8_t{kNoLine}
                                                                           : lines_.at(u, v);
  }

  /// Most of the seed lies on lines already found: long lines give a seed in every tile.
  [[nodiscard]] bool is_explained(const PixelSegment& s) const {
    const int steps = std::max(4, static_cast<int>(s.length_px() / 4));
    int seen = 0, taken = 0;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const int u = static_cast<int>(std::lerp(s.u1, s.u2, t)),
                v = static_cast<int>(std::lerp(s.v1, s.v2, t));
      std::uint8_t value = at(u, v);
      for (const int step : {-1, 1}) value |= static_cast<std::uint8_t>(at(u + step, v) | at(u, v + step));
      seen += value != kNoLine ? 1 : 0;
      taken += (value & kTaken) != 0 ? 1 : 0;
    }
    return taken >= kExplained * seen;
  }

  /// The line's pixel at this position along it, the nearest within the corridor.
  [[nodiscard]] std::optional<LinePoint> pixel_at(const FittedLine& line, double along) const {
    const double u = line.middle_u + along * line.direction_u, v = line.middle_v + along * line.direction_v;
    const bool flat = std::abs(line.direction_u) >= std::abs(line.direction_v);
    const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
    for (const int step : {0, 1, -1, 2, -2}) {
      const int pu = flat ? u0 : u0 + step, pv = flat ? v0 + step : v0;
      if (at(pu, pv) == kNoLine) continue;
      const LinePoint point{pu + 0.5, pv + 0.5};
      if (std::abs(line.across(point.u, point.v)) <= kCorridor) return point;
    }
    return std::nullopt;
  }

  /// Pixels from `middle` outward in one sense, up to `limit`, ending at the first large gap.
  void walk(const FittedLine& line, double middle, double limit, double sense) {
    const double step = 1 / std::max(std::abs(line.direction_u), std::abs(line.direction_v));
    double last_seen = middle;
    for (double along = middle; sense * (along - limit) <= 0; along += sense * step) {
      if (const auto point = pixel_at(line, along)) {
        pixels_.push_back(*point);
        last_seen = along;
      } else if (std::abs(along - last_seen) > options_.largest_gap_px) {
        break;
      }
    }
  }

  void collect(const FittedLine& line, double from, double to, double reach) {
    pixels_.clear();
    const double middle = 0.5 * (from + to);
    walk(line, middle, from - reach, -1);
    std::reverse(pixels_.begin(), pixels_.end());
    walk(line, middle, to + reach, 1);
  }

  std::optional<DrawnLine> accept(const FittedLine& line, double from, double to) {
    std::size_t fresh = 0, faces = 0, connected = 0;
    const LinePoint* previous = nullptr;
    for (const LinePoint& p : pixels_) {
      const auto value = at(static_cast<int>(p.u), static_cast<int>(p.v));
      fresh += (value & kTaken) == 0 ? 1 : 0;
      faces += (value & kSolidFace) != 0 ? 1 : 0;
      connected += previous && std::abs(p.u - previous->u) <= 1 && std::abs(p.v - previous->v) <= 1 ? 1 : 0;
      previous = &p;
    }
    const auto count = static_cast<double>(pixels_.size());
    if (to - from < options_.shortest_px || static_cast<double>(fresh) < options_.least_fresh_share * count)
      return std::nullopt;
    if (static_cast<double>(connected) < kLeastConnected * (to - from) * longest_component(line) ||
        bows(line, from, to))
      return std::nullopt;
    for (const LinePoint& p : pixels_) mark(static_cast<int>(p.u), static_cast<int>(p.v));
    DrawnLine drawn;
    drawn.segment = line.segment(from - 0.5, to + 0.5);
    drawn.solid_face = 2 * faces > pixels_.size();
    drawn.residual_px = line.residual;
    return drawn;
  }

  /// Pixels a unit of length: a digital line has one a column (or row).
  static double longest_component(const FittedLine& line) {
    return std::max(std::abs(line.direction_u), std::abs(line.direction_v));
  }

  /// A piece of an arc: the middle third lies aside of the outer thirds. Left to the chains, which bend.
  [[nodiscard]] bool bows(const FittedLine& line, double from, double to) const {
    double sum[3] = {0, 0, 0};
    int count[3] = {0, 0, 0};
    for (const LinePoint& p : pixels_) {
      const int third = std::clamp(static_cast<int>(3 * (line.along(p.u, p.v) - from) / (to - from)), 0, 2);
      sum[third] += line.across(p.u, p.v);
      ++count[third];
    }
    if (count[0] == 0 || count[1] == 0 || count[2] == 0) return false;
    const double bow = sum[1] / count[1] - 0.5 * (sum[0] / count[0] + sum[2] / count[2]);
    return std::abs(bow) > kLargestBow + kBowShare * (to - from);
  }

  void mark(int u, int v) {
    lines_.pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(lines_.width_px) +
                  static_cast<std::size_t>(u)] |= kTaken;
  }

  GrayImage& lines_;
  const RefineOptions& options_;
  std::vector<LinePoint> pixels_;
};

}  // namespace

DrawnLines refine_lines(GrayImage& lines, const std::vector<PixelSegment>& seeds,
                        const RefineOptions& options) {
  Follower follower(lines, options);
  DrawnLines found;
  for (const PixelSegment& seed : seeds)
    if (const auto line = follower.follow(seed)) found.push_back(*line);
  return found;
}

}  // namespace madori::mapping
