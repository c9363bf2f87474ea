#include "mapping/drawing/raster/trace_chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "mapping/drawing/raster/line_picture.hpp"
#include "mapping/drawing/raster/skip_paper.hpp"

namespace madori::mapping {
namespace {

struct Pixel {
  int u = 0, v = 0;
};
// Straight neighbours before diagonal ones, so that a walk never cuts a corner pixel off.
constexpr std::array<Pixel, 8> kAround{
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

class Tracer {
 public:
  explicit Tracer(GrayImage& lines) : lines_(lines) {}

  std::vector<std::vector<Pixel>> walks(std::size_t least_pixels) {
    std::vector<std::vector<Pixel>> found;
    const std::vector<Pixel> free = free_pixels();
    for (const bool only_ends : {true, false}) {  // loops have no end: they are opened last
      for (const Pixel& start : free) {
        if (!is_free(start) || (only_ends && free_neighbours(start) > 1)) continue;
        auto walk = walk_from(start);
        if (walk.size() >= least_pixels) found.push_back(std::move(walk));
      }
    }
    return found;
  }

 private:
  [[nodiscard]] std::uint8_t& value(const Pixel& p) const {
    return lines_.pixels[static_cast<std::size_t>(p.v) * static_cast<std::size_t>(lines_.width_px) +
                         static_cast<std::size_t>(p.u)];
  }
  [[nodiscard]] bool inside(const Pixel& p) const {
    return p.u >= 0 && p.v >= 0 && p.u < lines_.width_px && p.v < lines_.height_px;
  }
  [[nodiscard]] bool is_free(const Pixel& p) const {
    return inside(p) && value(p) != kNoLine && (value(p) & kTaken) == 0;
  }
  [[nodiscard]] int free_neighbours(const Pixel& p) const {
    return static_cast<int>(std::count_if(kAround.begin(), kAround.end(), [&](const Pixel& step) {
      return is_free({p.u + step.u, p.v + step.v});
    }));
  }

  [[nodiscard]] std::vector<Pixel> free_pixels() const {
    std::vector<Pixel> found;
    const std::uint8_t* pixels = lines_.pixels.data();
    const std::size_t size = lines_.pixels.size();
    for (std::size_t at = skip_paper(pixels, 0, size); at < size; at = skip_paper(pixels, at + 1, size)) {
      const Pixel p{static_cast<int>(at % static_cast<std::size_t>(lines_.width_px)),
                    static_cast<int>(at / static_cast<std::size_t>(lines_.width_px))};
      if (is_free(p)) found.push_back(p);
    }
    return found;
  }

  /// A taken pixel beside the walk's end: the line that the walk starts from or runs into.
  [[nodiscard]] std::optional<Pixel> touching(const Pixel& p) const {
    for (const Pixel& step : kAround) {
      const Pixel next{p.u + step.u, p.v + step.v};
      if (inside(next) && (value(next) & kTaken) != 0) return next;
    }
    return std::nullopt;
  }

  std::vector<Pixel> walk_from(const Pixel& start) {
    std::vector<Pixel> walk;
    if (const auto line = touching(start)) walk.push_back(*line);
    const std::size_t own = walk.size();
    for (std::optional<Pixel> at = start; at;) {
      walk.push_back(*at);
      const Pixel here = *at;
      value(here) |= kTaken;
      at.reset();
      for (const Pixel& step : kAround) {
        const Pixel next{here.u + step.u, here.v + step.v};
        if (!is_free(next)) continue;
        at = next;
        break;
      }
    }
    finish(walk, own);
    return walk;
  }

  static bool is_same(const Pixel& a, const Pixel& b) { return a.u == b.u && a.v == b.v; }

  /// Ends the walk on the line it runs into, or on its own start if it is a loop.
  void finish(std::vector<Pixel>& walk, std::size_t own) {
    const Pixel last = walk.back();
    for (const Pixel& step : kAround) {
      const Pixel next{last.u + step.u, last.v + step.v};
      if (!inside(next) || (value(next) & kTaken) == 0) continue;
      const std::size_t recent = std::min<std::size_t>(walk.size() - own, 4);
      const bool just_walked = std::any_of(walk.end() - static_cast<std::ptrdiff_t>(recent), walk.end(),
                                           [&](const Pixel& p) { return is_same(p, next); });
      if (just_walked) continue;
      walk.push_back(next);
      break;
    }
  }

  GrayImage& lines_;
};

/// Keeps the ends of [first, last] and, where a point is further off than the tolerance, splits there.
void simplify(const std::vector<Pixel>& walk, std::size_t first, std::size_t last, double tolerance,
              std::vector<std::size_t>& kept) {
  const Pixel a = walk[first], b = walk[last];
  const double length = std::hypot(b.u - a.u, b.v - a.v);
  double worst = tolerance;
  std::size_t split = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double du = walk[i].u - a.u, dv = walk[i].v - a.v;
    const double off =
        length > 0 ? std::abs(du * (b.v - a.v) - dv * (b.u - a.u)) / length : std::hypot(du, dv);
    if (off <= worst) continue;
    worst = off;
    split = i;
  }
  if (split > 0) {
    simplify(walk, first, split, tolerance, kept);
    simplify(walk, split, last, tolerance, kept);
    return;
  }
  kept.push_back(last);
}

}  // namespace

std::vector<Chain> trace_chains(GrayImage& lines, double tolerance_px, std::size_t least_pixels) {
  std::vector<Chain> chains;
  for (const auto& walk : Tracer(lines).walks(least_pixels)) {
    std::vector<std::size_t> kept{0};
    simplify(walk, 0, walk.size() - 1, tolerance_px, kept);
    Chain chain;
    for (const std::size_t i : kept) chain.corners.push_back({walk[i].u + 0.5, walk[i].v + 0.5});
    const Pixel& middle = walk[walk.size() / 2];
    chain.solid_face = (lines.at(middle.u, middle.v) & kSolidFace) != 0;
    chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace madori::mapping
