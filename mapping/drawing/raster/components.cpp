#include "mapping/drawing/raster/components.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "mapping/drawing/raster/skip_paper.hpp"

namespace madori::mapping {
namespace {

/// Union-find over run indices, with path halving; the smallest index is the root.
class Forest {
 public:
  explicit Forest(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t root(std::int32_t i) {
    while (at(i) != i) {
      at(i) = at(at(i));
      i = at(i);
    }
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    at(std::max(a, b)) = std::min(a, b);
  }

 private:
  std::int32_t& at(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<std::int32_t> parent_;
};

int paper_end(const std::uint8_t* row, int u, int width) {
  return static_cast<int>(skip_paper(row, static_cast<std::size_t>(u), static_cast<std::size_t>(width)));
}

int skip_ink(const std::uint8_t* row, int u, int width) {
  while (u < width && row[u] != 0) ++u;
  return u;
}

void append_runs(const std::uint8_t* row, int v, int width, bool of_paper, std::vector<Run>& runs) {
  for (int u = 0; u < width;) {
    const int first = of_paper ? skip_ink(row, u, width) : paper_end(row, u, width);
    if (first >= width) break;
    u = of_paper ? paper_end(row, first, width) : skip_ink(row, first, width);
    runs.push_back({v, first, u - 1, 0});
  }
}

}  // namespace

Components::Components(const GrayImage& ink, bool of_paper) : touch_(of_paper ? 0 : 1) {
  const auto width = static_cast<std::size_t>(ink.width_px);
  for (int v = 0; v < ink.height_px; ++v) {
    row_start_.push_back(runs_.size());
    append_runs(&ink.pixels[static_cast<std::size_t>(v) * width], v, ink.width_px, of_paper, runs_);
  }
  row_start_.push_back(runs_.size());
  connect_rows();
  describe();
}

void Components::connect_rows() {
  Forest forest(runs_.size());
  for (int v = 1; static_cast<std::size_t>(v) + 1 < row_start_.size(); ++v) {
    const auto above = row(v - 1), here = row(v);
    for (std::size_t a = 0, b = 0; a < above.size() && b < here.size();) {
      if (above[a].first <= here[b].last + touch_ && here[b].first <= above[a].last + touch_)
        forest.join(static_cast<std::int32_t>(&above[a] - runs_.data()),
                    static_cast<std::int32_t>(&here[b] - runs_.data()));
      if (above[a].last < here[b].last) {
        ++a;
      } else {
        ++b;
      }
    }
  }
  std::int32_t count = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {  // a root comes before all its runs
    const auto root = static_cast<std::size_t>(forest.root(static_cast<std::int32_t>(i)));
    runs_[i].component = root == i ? count++ : runs_[root].component;
  }
  components_.resize(static_cast<std::size_t>(count));
}

void Components::describe() {
  constexpr Component kNone{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), 0, 0};
  std::fill(components_.begin(), components_.end(), kNone);
  for (const Run& run : runs_) {
    Component& c = components_[static_cast<std::size_t>(run.component)];
    c.left = std::min(c.left, run.first);
    c.right = std::max(c.right, run.last);
    c.top = std::min(c.top, run.v);
    c.bottom = run.v;
    c.area_px += run.length();
  }
  if (touch_ == 1) describe_axes();
}

void Components::describe_axes() {
  std::vector<std::array<double, 5>> sums(components_.size());  // u, v, uu, uv, vv
  for (const Run& run : runs_) {
    const double n = run.length(), u = 0.5 * (run.first + run.last) + 0.5, v = run.v + 0.5;
    auto& sum = sums[static_cast<std::size_t>(run.component)];
    const std::array<double, 5> more{n * u, n * v, n * (u * u + n * n / 12), n * u * v,
                                     n * (v * v + 1.0 / 12)};
    for (std::size_t k = 0; k < more.size(); ++k) sum[k] += more[k];
  }
  for (std::size_t i = 0; i < components_.size(); ++i) {
    Component& c = components_[i];
    const auto area = static_cast<double>(c.area_px);
    c.middle_u = sums[i][0] / area;
    c.middle_v = sums[i][1] / area;
    const double uu = sums[i][2] / area - c.middle_u * c.middle_u;
    const double uv = sums[i][3] / area - c.middle_u * c.middle_v;
    const double vv = sums[i][4] / area - c.middle_v * c.middle_v;
    const double half = 0.5 * (uu + vv), root = std::hypot(0.5 * (uu - vv), uv);
    c.angle_rad = 0.5 * std::atan2(2 * uv, uu - vv);
    c.long_px = std::sqrt(12 * std::max(half + root, 1.0 / 12));
    c.short_px = std::sqrt(12 * std::max(half - root, 1.0 / 12));
  }
}

std::span<const Run> Components::row(int v) const {
  const auto i = static_cast<std::size_t>(v);
  return std::span(runs_).subspan(row_start_[i], row_start_[i + 1] - row_start_[i]);
}

int Components::at(int u, int v) const {
  if (v < 0 || static_cast<std::size_t>(v) + 1 >= row_start_.size()) return -1;
  const auto runs = row(v);
  const auto after = std::upper_bound(runs.begin(), runs.end(), u,
                                      [](int column, const Run& run) { return column < run.first; });
  if (after == runs.begin() || std::prev(after)->last < u) return -1;
  return std::prev(after)->component;
}

void Components::paint(GrayImage& picture, const std::vector<bool>& chosen, std::uint8_t value) const {
  for (const Run& run : runs_) {
    if (!chosen[static_cast<std::size_t>(run.component)]) continue;
    const auto start = picture.pixels.begin() + static_cast<std::ptrdiff_t>(run.v) * picture.width_px;
    std::fill(start + run.first, start + run.last + 1, value);
  }
}

}  // namespace madori::mapping
