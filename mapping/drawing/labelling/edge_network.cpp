#include "mapping/drawing/labelling/edge_network.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>
#include <numeric>

namespace madori::mapping {
namespace {

constexpr double kTouch = 3.5;         // pixels: ends this near belong together
constexpr double kStraightSine = 0.1;  // up to 6 degrees an edge goes on
constexpr double kDoorway = 0.04;      // of the sheet: a gap that a wall may have
constexpr double kSameLine = 2;        // pixels off the line

double sine_between(const Edge& a, const Edge& b) {
  return std::abs(a.normal.cross(b.normal));
}
double cosine_between(const Edge& a, const Edge& b) {
  return a.normal.dot(b.normal);
}

class Clusters {
 public:
  explicit Clusters(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

class Linker {
 public:
  explicit Linker(const EdgeSheet& sheet)
      : sheet_(sheet),
        links_(sheet.edges.size()),
        clusters_(sheet.edges.size()),
        chains_(sheet.edges.size()) {}

  std::vector<EdgeLinks> run(const std::vector<EdgeViews>& views) {
    auto beside = std::async(std::launch::async, [&] { chains(); });
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const PixelSegment& s = sheet_.edges[i].segment;
      links_[i].ends = {end_at(i, s.u1, s.v1), end_at(i, s.u2, s.v2)};
      if (links_[i].ends[0].longest_px < links_[i].ends[1].longest_px)
        std::swap(links_[i].ends[0], links_[i].ends[1]);
      const int partner = views[i].dark.hits[0].edge;
      if (partner >= 0) clusters_.join(i, static_cast<std::size_t>(partner));
    }
    beside.get();
    measure_clusters();
    return std::move(links_);
  }

 private:
  EdgeLinks::End end_at(std::size_t i, double u, double v) {
    near_.clear();
    const int reach = static_cast<int>(std::ceil(kTouch));
    for (int dv = -reach; dv <= reach; ++dv)
      for (int du = -reach; du <= reach; ++du) {
        if (!sheet_.inside(u + du, v + dv)) continue;
        const int other = sheet_.map.edge_at(sheet_.pixel(u + du, v + dv));
        if (other >= 0 && other != static_cast<int>(i)) near_.push_back(other);
      }
    std::sort(near_.begin(), near_.end());
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
    EdgeLinks::End end;
    double least_turn = std::numbers::pi;
    for (const int number : near_) {
      const auto j = static_cast<std::size_t>(number);
      const Edge &edge = sheet_.edges[i], &other = sheet_.edges[j];
      const bool ends_here = std::min(std::hypot(other.segment.u1 - u, other.segment.v1 - v),
                                      std::hypot(other.segment.u2 - u, other.segment.v2 - v)) < 1.5 * kTouch;
      const double sine = sine_between(edge, other);
      clusters_.join(i, j);
      if (sine < kStraightSine) {
        if (ends_here && cosine_between(edge, other) > 0) ++end.continuing;
        continue;
      }
      ends_here ? ++end.corners : ++end.tees;
      if (!ends_here) ++links_[j].abutting;
      end.longest_px = std::max(end.longest_px, other.length_px);
      if (ends_here) least_turn = std::min(least_turn, std::asin(std::min(1.0, sine)));
    }
    if (least_turn < std::numbers::pi) end.turn_rad = least_turn;
    return end;
  }

  /// Edges sorted by direction and offset: those of one line stand together.
  void chains() {
    constexpr int kDirections = 90;
    std::vector<std::vector<std::size_t>> by_direction(kDirections);
    const double mu = 0.5 * (sheet_.box.left + sheet_.box.right),
                 mv = 0.5 * (sheet_.box.top + sheet_.box.bottom);
    std::vector<double> offsets(sheet_.edges.size());
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const Edge& e = sheet_.edges[i];
      by_direction[static_cast<std::size_t>(e.angle_rad / std::numbers::pi * kDirections) % kDirections]
          .push_back(i);
      offsets[i] = std::abs((0.5 * (e.segment.u1 + e.segment.u2) - mu) * e.normal.x +
                            (0.5 * (e.segment.v1 + e.segment.v2) - mv) * e.normal.y);
    }
    const auto by_offset = [&](std::size_t a, std::size_t b) { return offsets[a] < offsets[b]; };
    for (auto& bin : by_direction) std::stable_sort(bin.begin(), bin.end(), by_offset);
    for (std::size_t d = 0; d < kDirections; ++d)
      for (const std::size_t i : by_direction[d]) {
        stretches_.clear();
        for (const std::size_t bin : {(d + kDirections - 1) % kDirections, d, (d + 1) % kDirections}) {
          const double slack = kSameLine + 0.04 * sheet_.size_px();  // a small turn moves far ends apart
          const auto& row = by_direction[bin];
          auto at = std::lower_bound(row.begin(), row.end(), offsets[i] - slack,
                                     [&](std::size_t a, double value) { return offsets[a] < value; });
          for (; at != row.end() && offsets[*at] <= offsets[i] + slack; ++at) add_stretch(i, *at);
        }
        measure_chain(i);
      }
  }

  void add_stretch(std::size_t i, std::size_t j) {
    const Edge &edge = sheet_.edges[i], &other = sheet_.edges[j];
    if (cosine_between(edge, other) < 0.99) return;
    const auto across = [&](double u, double v) {
      return (u - edge.segment.u1) * edge.normal.x + (v - edge.segment.v1) * edge.normal.y;
    };
    const double middle =
        across(0.5 * (other.segment.u1 + other.segment.u2), 0.5 * (other.segment.v1 + other.segment.v2));
    if (std::abs(middle) > kSameLine) return;
    const auto along = [&](double u, double v) {
      return (v - edge.segment.v1) * edge.normal.x - (u - edge.segment.u1) * edge.normal.y;
    };
    const double a = along(other.segment.u1, other.segment.v1), b = along(other.segment.u2, other.segment.v2);
    stretches_.push_back({std::min(a, b), std::max(a, b), j, j == i});
  }

  void measure_chain(std::size_t i) {
    std::sort(stretches_.begin(), stretches_.end(),
              [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
    std::size_t self = 0;
    for (std::size_t k = 0; k < stretches_.size(); ++k) {
      links_[i].line_px += stretches_[k].to - stretches_[k].from;
      if (stretches_[k].self) self = k;
    }
    const double gap = kDoorway * sheet_.size_px();
    std::size_t first = self, last = self;
    while (first > 0 && stretches_[first].from - stretches_[first - 1].to < gap) --first;
    while (last + 1 < stretches_.size() && stretches_[last + 1].from - stretches_[last].to < gap) ++last;
    for (std::size_t k = first; k <= last; ++k) {
      links_[i].chain.length_px += stretches_[k].to - stretches_[k].from;
      chains_.join(i, stretches_[k].edge);
    }
    links_[i].chain.edges = static_cast<int>(last - first) + 1;
    links_[i].chain.extent_px = stretches_[last].to - stretches_[first].from;
  }

  void measure_clusters() {
    std::vector<EdgeLinks::Group> clusters(links_.size());
    std::vector<PixelBox> boxes(links_.size());
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const std::size_t number = clusters_.root(i);
      EdgeLinks::Group& cluster = clusters[number];
      boxes[number].add(sheet_.edges[i].segment);
      cluster = {number, cluster.edges + 1, cluster.length_px + sheet_.edges[i].length_px,
                 boxes[number].diagonal()};
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
      links_[i].cluster = clusters[clusters_.root(i)];
      links_[i].chain.number = chains_.root(i);
    }
  }

  struct Stretch {
    double from = 0, to = 0;
    std::size_t edge = 0;
    bool self = false;
  };
  const EdgeSheet& sheet_;
  std::vector<EdgeLinks> links_;
  Clusters clusters_, chains_;
  std::vector<int> near_;
  std::vector<Stretch> stretches_;
};

}  // namespace

std::vector<EdgeLinks> link_edges(const EdgeSheet& sheet, const std::vector<EdgeViews>& views) {
  return Linker(sheet).run(views);
}

}  // namespace madori::mapping
