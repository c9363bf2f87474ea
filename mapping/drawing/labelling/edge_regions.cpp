#include "mapping/drawing/labelling/edge_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace madori::mapping {
namespace {

constexpr float kBarrier = 1.2F;  // pixels: edges seal corners that miss each other by a pixel or two
constexpr double kBeside = 3;     // pixels off an edge its regions begin

/// Connected areas by runs of open pixels in each row: a drawing is mostly paper, whose runs are long.
class Areas {
 public:
  explicit Areas(const EdgeSheet& sheet) : sheet_(sheet) {
    for (int v = 0; v < sheet.grey.height_px; ++v) {
      rows_.push_back(runs_.size());
      find_runs(v);
      if (v > 0) join(rows_[rows_.size() - 2], rows_.back());
    }
    rows_.push_back(runs_.size());
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const std::size_t first = root(k);
      if (first != k) runs_[first].region.add(runs_[k].region);
    }
  }

  /// The region that most places beside the edge lie in; none where they lie between edges.
  [[nodiscard]] Region beside(const Edge& edge, double side) {
    std::map<std::size_t, int> votes;
    const int places = std::clamp(static_cast<int>(edge.length_px / 6), 3, 9);
    for (int k = 0; k < places; ++k) {
      const double t = (k + 0.5) / places;
      const double u = std::lerp(edge.segment.u1, edge.segment.u2, t) + side * kBeside * edge.normal.x;
      const double v = std::lerp(edge.segment.v1, edge.segment.v2, t) + side * kBeside * edge.normal.y;
      if (!sheet_.inside(u, v)) continue;
      if (const auto run = run_at(static_cast<int>(u), static_cast<int>(v))) ++votes[root(*run)];
    }
    if (votes.empty()) return {};
    const auto most = std::max_element(votes.begin(), votes.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return of(runs_[most->first].region);
  }

 private:
  struct Sums {
    double area = 0, grey = 0;
    cv::Rect box;
    void add(const Sums& o) { area += o.area, grey += o.grey, box |= o.box; }
  };
  struct Run {
    int from = 0, to = 0;
    std::size_t parent = 0;
    Sums region;
  };

  void find_runs(int v) {
    const auto width = static_cast<std::size_t>(sheet_.grey.width_px);
    const std::size_t row = static_cast<std::size_t>(v) * width;
    const auto open = [&](std::size_t u) { return sheet_.map.is_clear(row + u, kBarrier); };
    const std::uint8_t* grey = &sheet_.grey.pixels[row];
    for (std::size_t u = 0; u < width;) {
      while (u < width && !open(u)) ++u;
      const std::size_t from = u;
      u = sheet_.map.end_of_clear(row + u, row + width, kBarrier) - row;
      if (from == u) break;
      const int left = static_cast<int>(from), right = static_cast<int>(u);
      const Sums sums{static_cast<double>(u - from),
                      static_cast<double>(sum_of(grey + from, grey + u)),
                      {left, v, right - left, 1}};
      runs_.push_back({left, right, runs_.size(), sums});
    }
  }

  static int sum_of(const std::uint8_t* from, const std::uint8_t* to) {
    int sum = 0;
#pragma omp simd reduction(+ : sum)
    for (const std::uint8_t* at = from; at < to; ++at) sum += *at;
    return sum;
  }

  /// Runs of two rows, from `above` to `here` and from `here` on, that touch are of one region.
  void join(std::size_t above, const std::size_t here) {
    for (std::size_t run = here; run < runs_.size(); ++run) {
      while (above < here && runs_[above].to <= runs_[run].from) ++above;
      for (std::size_t other = above; other < here && runs_[other].from < runs_[run].to; ++other) {
        const std::size_t a = root(other), b = root(run);
        runs_[std::max(a, b)].parent = std::min(a, b);
      }
    }
  }

  std::size_t root(std::size_t i) {
    while (runs_[i].parent != i) i = runs_[i].parent = runs_[runs_[i].parent].parent;
    return i;
  }

  [[nodiscard]] std::optional<std::size_t> run_at(int u, int v) const {
    const auto row = static_cast<std::size_t>(v);
    const auto first = runs_.begin() + static_cast<std::ptrdiff_t>(rows_[row]);
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(rows_[row + 1]);
    const auto run = std::upper_bound(first, end, u, [](int at, const Run& r) { return at < r.to; });
    if (run == end || u < run->from) return std::nullopt;
    return static_cast<std::size_t>(run - runs_.begin());
  }

  [[nodiscard]] Region of(const Sums& s) const {
    return {s.area, s.box.size(), s.grey / std::max(1.0, s.area),
            s.box.x == 0 || s.box.y == 0 || s.box.br().x == sheet_.grey.width_px ||
                s.box.br().y == sheet_.grey.height_px};
  }

  const EdgeSheet& sheet_;
  std::vector<Run> runs_;          // row by row; those of a region hang below its first
  std::vector<std::size_t> rows_;  // the first run of each row, and the end of all
};

}  // namespace

std::vector<EdgeRegions> regions_beside(const EdgeSheet& sheet) {
  Areas areas(sheet);
  std::vector<EdgeRegions> regions;
  for (const Edge& edge : sheet.edges) regions.push_back({areas.beside(edge, 1), areas.beside(edge, -1)});
  return regions;
}

}  // namespace madori::mapping
