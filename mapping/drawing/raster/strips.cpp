#include "mapping/drawing/raster/strips.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kParallel = 0.12;  // radians
constexpr double kNarrowest = 2.0;  // pixels between the middles of two strokes
constexpr double kStep = 3;         // between samples along a line
constexpr double kBlock = 1.3;      // strip widths
constexpr double kCore = 0.2;       // of the width, to either side of the strip's middle

/// One line that runs along another at some distance, over [from, to] of it.
struct Neighbour {
  std::size_t line = 0;
  double from = 0, to = 0;
  double off_from = 0, off_to = 0;  // signed distance at both ends of the stretch

  [[nodiscard]] double off(double at) const {
    return to > from ? std::lerp(off_from, off_to, (at - from) / (to - from)) : off_from;
  }
};

std::vector<Neighbour> neighbours_of(std::size_t self, const DrawnLines& lines, const LineIndex& index,
                                     double widest_px) {
  std::vector<Neighbour> found;
  const DrawnLine& own = lines[self];
  const FittedLine axis = line_through(own.segment);
  const double half = 0.5 * own.length_px();
  index.near(own.segment, widest_px, [&](std::size_t other) {
    if (other == self || angle_between(own.angle_rad(), lines[other].angle_rad()) > kParallel) return;
    const PixelSegment& s = lines[other].segment;
    double a = axis.along(s.u1, s.v1), b = axis.along(s.u2, s.v2);
    double off_a = axis.across(s.u1, s.v1), off_b = axis.across(s.u2, s.v2);
    if (a > b) {
      std::swap(a, b);
      std::swap(off_a, off_b);
    }
    const double from = std::max(a, -half), to = std::min(b, half);
    if (to - from < kStep) return;
    const auto off_at = [&](double at) { return std::lerp(off_a, off_b, (at - a) / (b - a)); };
    const Neighbour n{other, from + half, to + half, off_at(from), off_at(to)};
    const double near = std::min(std::abs(n.off_from), std::abs(n.off_to));
    if (near <= widest_px && (n.off_from > 0) == (n.off_to > 0)) found.push_back(n);
  });
  return found;
}

/// The share of the strip's length that has ink in its middle two fifths, where the strokes of the faces do
/// not reach; in blocks about as long as the strip is wide, so that even hatching counts whole and a symbol
/// little.
double ink_between(const GrayImage& ink, const FittedLine& axis, const Strip& strip, double off,
                   double stroke_px) {
  const double width = std::abs(off), half = std::max(0.0, kCore * width);
  if (width < stroke_px + 2) return 0;
  const int blocks = std::max(1, static_cast<int>(strip.length_px() / (kBlock * width)));
  int inked = 0;
  for (int block = 0; block < blocks; ++block) {
    bool dark = false;
    const int steps = static_cast<int>(std::ceil(kBlock * width - 0.5));
    for (int step = 0; step < steps && !dark; ++step) {
      const double along = strip.from_px + strip.length_px() * block / blocks + step + 0.5;
      for (int k = 0; k <= static_cast<int>(2 * half + 0.01) && !dark; ++k) {
        const double across = 0.5 * width - half + k;
        const double side = off > 0 ? across : -across;
        const int u = static_cast<int>(axis.middle_u + along * axis.direction_u - side * axis.direction_v);
        const int v = static_cast<int>(axis.middle_v + along * axis.direction_v + side * axis.direction_u);
        dark = u >= 0 && v >= 0 && u < ink.width_px && v < ink.height_px && ink.at(u, v) != 0;
      }
    }
    inked += dark ? 1 : 0;
  }
  return static_cast<double>(inked) / blocks;
}

/// The strips on one side of one line: at every sample the nearest neighbour, neighbours in a row joined.
class SideWalk {
 public:
  SideWalk(std::size_t line, bool left, double widest_px) : line_(line), left_(left), widest_px_(widest_px) {}

  std::vector<Strip> run(const std::vector<Neighbour>& neighbours, double length) {
    const int samples = static_cast<int>(length / kStep);
    for (int i = 0; i < samples; ++i) {
      const double at = (i + 0.5) * kStep;
      const Neighbour* nearest = nearest_at(neighbours, at);
      if (nearest != current_) {
        close(at - 0.5 * kStep);
        current_ = nearest;
      }
      if (current_ == nullptr) continue;
      width_sum_ += std::abs(current_->off(at));
      ++samples_;
    }
    close(length);
    return strips_;
  }

 private:
  [[nodiscard]] const Neighbour* nearest_at(const std::vector<Neighbour>& neighbours, double at) const {
    const Neighbour* nearest = nullptr;
    for (const Neighbour& n : neighbours) {
      if (at < n.from || at > n.to) continue;
      const double off = n.off(at);
      if ((off < 0) != left_ || std::abs(off) < kNarrowest || std::abs(off) > widest_px_) continue;
      if (nearest == nullptr || std::abs(off) < std::abs(nearest->off(at))) nearest = &n;
    }
    return nearest;
  }
  void close(double at) {
    if (current_ != nullptr && at - since_ >= 2 * kStep)
      strips_.push_back({line_, current_->line, width_sum_ / samples_, since_, at, 0});
    since_ = at;
    width_sum_ = 0;
    samples_ = 0;
  }

  std::size_t line_;
  bool left_;
  double widest_px_;
  const Neighbour* current_ = nullptr;
  double since_ = 0, width_sum_ = 0;
  int samples_ = 0;
  std::vector<Strip> strips_;
};

}  // namespace

std::vector<Strip> find_strips(const DrawnLines& lines, const GrayImage& ink, double widest_px) {
  const LineIndex index(lines, 64);
  std::vector<Strip> strips;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto neighbours = neighbours_of(i, lines, index, widest_px);
    if (neighbours.empty()) continue;
    FittedLine axis = line_through(lines[i].segment);
    axis.middle_u = lines[i].segment.u1;  // positions count from the first end
    axis.middle_v = lines[i].segment.v1;
    for (const bool left : {false, true}) {
      for (Strip& strip : SideWalk(i, left, widest_px).run(neighbours, lines[i].length_px())) {
        strip.ink_share = ink_between(ink, axis, strip, left ? -strip.width_px : strip.width_px,
                                      lines[i].solid_face ? 0 : lines[i].stroke_px);
        strips.push_back(strip);
      }
    }
  }
  return strips;
}

}  // namespace madori::mapping
