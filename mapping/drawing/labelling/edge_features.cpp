#include "mapping/drawing/labelling/edge_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

namespace madori::mapping {
namespace {

constexpr double kNone = -1;  // where a feature does not exist

/// The share of all edge length whose value is smaller (half of what is equal).
std::vector<float> ranks(const std::vector<double>& values, const std::vector<Edge>& edges) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  double total = 0, below = 0;
  for (const Edge& edge : edges) total += edge.length_px;
  std::vector<float> rank(values.size());
  for (std::size_t from = 0; from < order.size();) {
    std::size_t to = from;
    double equal = 0;
    while (to < order.size() && values[order[to]] <= values[order[from]])
      equal += edges[order[to++]].length_px;
    for (std::size_t k = from; k < to; ++k)
      rank[order[k]] = static_cast<float>((below + 0.5 * equal) / total);
    below += equal;
    from = to;
  }
  return rank;
}

double quantile(const std::vector<double>& values, const std::vector<Edge>& edges, double share) {
  const auto rank = ranks(values, edges);
  double best = 1, at = 2;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] > 0 && std::abs(rank[i] - share) < at) at = std::abs(rank[i] - share), best = values[i];
  return best;
}

class Builder {
 public:
  Builder(const EdgeSheet& sheet, EdgeMeasures& measures)
      : sheet_(sheet), m_(measures), edges_(sheet.edges), table_(sheet.edges.size()) {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const EdgeViews& view = m_.views[i];
      width_.push_back(view.dark.hits[0].opposite > 0.5 ? view.dark.hits[0].distance_px : 0);
      contrast_.push_back(view.bright.near_grey - view.dark.near_grey);
      total_ += edges_[i].length_px;
    }
    std::vector<double> pens;
    for (const double w : width_) pens.push_back(w > 0 ? w : 1e6);
    pen_ = std::clamp(quantile(pens, edges_, 0.25), 1.0, 0.01 * sheet.size_px() + 1);
    range_ = std::max(20.0, quantile(contrast_, edges_, 0.9));
  }

  FeatureTable build() {
    Builder rest(*this);  // on another thread, into a table of its own
    auto beside = std::async(std::launch::async, [&] {
      rest.place();
      rest.repeats();
      rest.styles();
    });
    own();
    sides();
    partners();
    beyond();
    openings();
    network();
    regions();
    beside.get();
    table_.add(rest.table_);
    m_.strokes = {std::move(width_), pen_};
    return std::move(table_);
  }

 private:
  template <class Value>
  void add(const std::string& name, Value value) {
    table_.fill(name, value);
  }
  [[nodiscard]] double of_size(double px) const { return px / sheet_.size_px(); }
  [[nodiscard]] double of_pen(double px) const { return px / pen_; }

  /// How far the colour beside an edge is from the ground's: 0 as it, 1 as far as colours go.
  [[nodiscard]] double colour(const SideView& side) const {
    return std::hypot(side.red_green - ground_red_green_, side.yellow_blue - ground_yellow_blue_) / 128;
  }

  void own() {
    add("length_size", [&](std::size_t i) { return of_size(edges_[i].length_px); });
    add("length_pen", [&](std::size_t i) { return of_pen(edges_[i].length_px); });
    add("width_pen", [&](std::size_t i) { return of_pen(width_[i]); });
    add("width_size", [&](std::size_t i) { return of_size(width_[i]); });
    add("width_px", [&](std::size_t i) { return width_[i]; });
    add("length_width",
        [&](std::size_t i) { return width_[i] > 0 ? edges_[i].length_px / width_[i] : kNone; });
    add("contrast", [&](std::size_t i) { return contrast_[i] / range_; });
    table_.add("contrast_rank", ranks(contrast_, edges_));
    table_.add("width_rank", ranks(width_, edges_));
    std::vector<double> lengths, darks;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      lengths.push_back(edges_[i].length_px);
      darks.push_back(m_.views[i].dark.near_grey);
    }
    table_.add("length_rank", ranks(lengths, edges_));
    table_.add("dark_rank", ranks(darks, edges_));
    add("dark_grey", [&](std::size_t i) { return (darks[i] - ground_) / range_; });
    add("dark_colour", [&](std::size_t i) { return colour(m_.views[i].dark); });
    add("bright_colour", [&](std::size_t i) { return colour(m_.views[i].bright); });
    add("colour_step", [&](std::size_t i) {
      const SideView &dark = m_.views[i].dark, &bright = m_.views[i].bright;
      return std::hypot(dark.red_green - bright.red_green, dark.yellow_blue - bright.yellow_blue) / 128;
    });
    add("bright_grey", [&](std::size_t i) { return (m_.views[i].bright.near_grey - ground_) / range_; });
  }

  void side(const std::string& name, bool dark) {
    const auto view = [this, dark](std::size_t i) -> const SideView& {
      return dark ? m_.views[i].dark : m_.views[i].bright;
    };
    for (std::size_t h = 0; h < SideView::kHits; ++h) {
      const std::string hit = name + "_hit" + std::to_string(h);
      const auto of = [view, h](std::size_t i) -> const SideView::ParallelHit& { return view(i).hits[h]; };
      add(hit + "_pen", [&](std::size_t i) { return of(i).share > 0 ? of_pen(of(i).distance_px) : kNone; });
      add(hit + "_size", [&](std::size_t i) { return of(i).share > 0 ? of_size(of(i).distance_px) : kNone; });
      add(hit + "_share", [&](std::size_t i) { return of(i).share; });
      add(hit + "_opposite", [&](std::size_t i) { return of(i).share > 0 ? of(i).opposite : kNone; });
      add(hit + "_after",
          [&](std::size_t i) { return of(i).share > 0 ? of_size(of(i).free_after_px) : kNone; });
    }
    add(name + "_free", [&](std::size_t i) { return of_size(view(i).free_px); });
    add(name + "_free_most", [&](std::size_t i) { return of_size(view(i).free_most_px); });
    add(name + "_open", [&](std::size_t i) { return view(i).open; });
    add(name + "_fill", [&](std::size_t i) { return (view(i).fill_grey - ground_) / range_; });
    add(name + "_fill_near", [&](std::size_t i) { return (view(i).fill_grey - view(i).near_grey) / range_; });
    add(name + "_fill_spread", [&](std::size_t i) { return view(i).fill_spread / range_; });
  }

  void sides() {
    side("dark", true);
    side("bright", false);
  }

  /// The edges that are met first: their length, contrast, width beside one's own.
  void partners() {
    const auto partner = [&](const std::string& name, auto edge_of) {
      add(name + "_length", [&](std::size_t i) {
        const int j = edge_of(i);
        return j < 0 ? kNone : std::log2(edges_[static_cast<std::size_t>(j)].length_px / edges_[i].length_px);
      });
      add(name + "_contrast", [&](std::size_t i) {
        const int j = edge_of(i);
        return j < 0 ? kNone : (contrast_[static_cast<std::size_t>(j)] - contrast_[i]) / range_;
      });
      add(name + "_width", [&](std::size_t i) {
        const int j = edge_of(i);
        return j < 0 ? kNone : of_pen(width_[static_cast<std::size_t>(j)]);
      });
    };
    partner("over_dark", [&](std::size_t i) { return m_.views[i].dark.hits[0].edge; });
    partner("over_bright", [&](std::size_t i) { return m_.views[i].bright.hits[0].edge; });
    partner("second_dark", [&](std::size_t i) { return m_.views[i].dark.hits[1].edge; });
  }

  /// What lies behind the stroke or body that an edge bounds: a wall has a room, or the outside, on both
  /// sides.
  void beyond() {
    const auto behind = [&](const std::string& name, auto value) {
      add("beyond_" + name, [&](std::size_t i) {
        const SideView::ParallelHit& hit = m_.views[i].dark.hits[0];
        return hit.edge >= 0 && hit.opposite > 0.5 ? value(static_cast<std::size_t>(hit.edge)) : kNone;
      });
    };
    const double whole = sheet_.size_px() * sheet_.size_px();
    behind("free", [&](std::size_t j) { return of_size(m_.views[j].bright.free_px); });
    behind("hit", [&](std::size_t j) {
      const SideView::ParallelHit& next = m_.views[j].bright.hits[0];
      return next.share > 0 ? of_size(next.distance_px) : kNone;
    });
    behind("open", [&](std::size_t j) { return m_.views[j].bright.open; });
    behind("grey", [&](std::size_t j) { return (m_.views[j].bright.near_grey - ground_) / range_; });
    behind("colour", [&](std::size_t j) { return colour(m_.views[j].bright); });
    behind("area", [&](std::size_t j) { return std::sqrt(m_.regions[j].bright.area_px / whole); });
    behind("border", [&](std::size_t j) { return m_.regions[j].bright.at_border ? 1.0 : 0.0; });
  }

  /// A door leaf or a pane goes on between the faces of a wall at both of its ends, and is thinner than the
  /// wall.
  void openings() {
    const auto ends = [&](std::size_t i) {
      const auto& past = m_.views[i].past_ends;
      return std::minmax({past[0].width_px(), past[1].width_px()});
    };
    add("between_less", [&](std::size_t i) { return of_pen(ends(i).first); });
    add("between_more", [&](std::size_t i) { return of_pen(ends(i).second); });
    add("between_width", [&](std::size_t i) { return width_[i] > 0 ? ends(i).first / width_[i] : kNone; });
    add("between_like",
        [&](std::size_t i) { return ends(i).second > 0 ? ends(i).first / ends(i).second : kNone; });
    add("between_length",
        [&](std::size_t i) { return ends(i).first > 0 ? edges_[i].length_px / ends(i).first : kNone; });
  }

  void network() {
    const auto& links = m_.links;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string end = "end" + std::to_string(k);
      add(end + "_continuing", [&](std::size_t i) { return links[i].ends[k].continuing; });
      add(end + "_corners", [&](std::size_t i) { return links[i].ends[k].corners; });
      add(end + "_tees", [&](std::size_t i) { return links[i].ends[k].tees; });
      add(end + "_turn", [&](std::size_t i) { return links[i].ends[k].turn_rad; });
      add(end + "_longest", [&](std::size_t i) { return of_size(links[i].ends[k].longest_px); });
    }
    add("abutting", [&](std::size_t i) { return links[i].abutting; });
    add("abutting_density", [&](std::size_t i) { return links[i].abutting * pen_ / edges_[i].length_px; });
    add("chain", [&](std::size_t i) { return of_size(links[i].chain.length_px); });
    add("chain_extent", [&](std::size_t i) { return of_size(links[i].chain.extent_px); });
    add("chain_solid",
        [&](std::size_t i) { return links[i].chain.length_px / std::max(1.0, links[i].chain.extent_px); });
    add("line", [&](std::size_t i) { return of_size(links[i].line_px); });
    add("cluster", [&](std::size_t i) { return links[i].cluster.length_px / total_; });
    add("cluster_size", [&](std::size_t i) { return of_size(links[i].cluster.extent_px); });
    add("cluster_mean",
        [&](std::size_t i) { return of_size(links[i].cluster.length_px / links[i].cluster.edges); });
    add("cluster_curl", [&](std::size_t i) {
      return links[i].cluster.length_px / std::max(1.0, links[i].cluster.extent_px);
    });
  }

  void regions() {
    const double whole = sheet_.size_px() * sheet_.size_px();
    const auto region = [&](const std::string& name, auto of) {
      add(name + "_area", [&](std::size_t i) { return std::sqrt(of(i).area_px / whole); });
      add(name + "_fill", [&](std::size_t i) { return of(i).area_px / std::max(1.0, of(i).box_px.area()); });
      add(name + "_short", [&](std::size_t i) { return of_size(of(i).short_side_px()); });
      add(name + "_long", [&](std::size_t i) { return of_size(of(i).long_side_px()); });
      add(name + "_grey", [&](std::size_t i) { return (of(i).grey - ground_) / range_; });
      add(name + "_border", [&](std::size_t i) { return of(i).at_border ? 1 : 0; });
    };
    region("dark_region", [&](std::size_t i) -> const Region& { return m_.regions[i].dark; });
    region("bright_region", [&](std::size_t i) -> const Region& { return m_.regions[i].bright; });
  }

  void place() {
    std::array<double, 90> turned{};
    const auto bin = [](const Edge& e) {
      return static_cast<std::size_t>(e.angle_rad / (0.5 * std::numbers::pi) * 90) % 90;
    };
    for (const Edge& e : edges_) turned[bin(e)] += e.length_px / total_;
    const auto smooth = [&](std::size_t k) {
      return turned[(k + 89) % 90] + turned[k] + turned[(k + 1) % 90];
    };
    add("direction_share", [&](std::size_t i) { return smooth(bin(edges_[i])); });
    const auto middle = [&](std::size_t i) {
      const PixelSegment& s = edges_[i].segment;
      return std::pair(0.5 * (s.u1 + s.u2), 0.5 * (s.v1 + s.v2));
    };
    add("from_outside", [&](std::size_t i) {
      const auto [u, v] = middle(i);
      return of_size(
          std::min({u - sheet_.box.left, sheet_.box.right - u, v - sheet_.box.top, sheet_.box.bottom - v}));
    });
    const double cell = std::max(4.0, 0.02 * sheet_.size_px());
    std::map<std::pair<int, int>, std::array<double, 3>>
        cells;  // length, length of short ones, turned length
    const auto cell_of = [&](std::size_t i) {
      const auto [u, v] = middle(i);
      return std::pair(static_cast<int>(u / cell), static_cast<int>(v / cell));
    };
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      auto& sums = cells[cell_of(i)];
      sums[0] += edges_[i].length_px;
      if (edges_[i].length_px < cell) sums[1] += edges_[i].length_px;
      if (smooth(bin(edges_[i])) < 0.1) sums[2] += edges_[i].length_px;
    }
    std::vector<std::array<double, 3>> around(edges_.size());
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const auto [column, row] = cell_of(i);
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
          if (const auto at = cells.find({column + du, row + dv}); at != cells.end())
            for (std::size_t k = 0; k < 3; ++k) around[i][k] += at->second[k] / cell;
    }
    add("clutter", [&](std::size_t i) { return around[i][0]; });
    add("clutter_short", [&](std::size_t i) { return around[i][1]; });
    add("clutter_turned", [&](std::size_t i) { return around[i][2]; });
  }

  void repeats() {
    std::map<std::tuple<int, int, int>, int> same;
    const auto key = [&](std::size_t i) {
      return std::tuple(static_cast<int>(edges_[i].angle_rad / std::numbers::pi * 36 + 0.5) % 36,
                        static_cast<int>(std::log2(edges_[i].length_px) * 8), static_cast<int>(width_[i]));
    };
    for (std::size_t i = 0; i < edges_.size(); ++i) ++same[key(i)];
    add("repeats", [&](std::size_t i) { return std::log2(same[key(i)]); });
    add("repeats_share", [&](std::size_t i) { return same[key(i)] * edges_[i].length_px / total_; });
  }

  /// What all lines of a style have in common: they are judged alike. `style` numbers each edge's.
  void style(const std::string& name, const std::vector<int>& style_of) {
    struct Style {
      double length = 0, squares = 0, chains = 0, paired = 0, size = 0, free = 0, regions = 0, turned = 0,
             straight = 0;
      PixelBox box;
    };
    std::map<int, Style> styles;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      Style& of = styles[style_of[i]];
      const double length = edges_[i].length_px;
      of.length += length;
      of.squares += length * length;
      of.chains += length * m_.links[i].chain.length_px;
      of.paired += length * m_.views[i].bright.hits[0].share;
      of.size += length * m_.links[i].cluster.extent_px;
      of.free += length * std::max(m_.views[i].bright.free_px, m_.views[i].dark.hits[0].free_after_px);
      of.regions += length * m_.regions[i].bright.long_side_px();
      of.straight += length * (m_.links[i].ends[0].continuing + m_.links[i].ends[1].continuing);
      of.box.add(edges_[i].segment);
    }
    const auto of = [&](std::size_t i) -> const Style& { return styles.at(style_of[i]); };
    add(name + "_share", [&](std::size_t i) { return of(i).length / total_; });
    add(name + "_length", [&](std::size_t i) { return of_size(of(i).squares / of(i).length); });
    add(name + "_chain", [&](std::size_t i) { return of_size(of(i).chains / of(i).length); });
    add(name + "_paired", [&](std::size_t i) { return of(i).paired / of(i).length; });
    add(name + "_cluster", [&](std::size_t i) { return of_size(of(i).size / of(i).length); });
    add(name + "_free", [&](std::size_t i) { return of_size(of(i).free / of(i).length); });
    add(name + "_region", [&](std::size_t i) { return of_size(of(i).regions / of(i).length); });
    add(name + "_straight", [&](std::size_t i) { return of(i).straight / of(i).length; });
    add(name + "_extent", [&](std::size_t i) { return of_size(of(i).box.diagonal()); });
    std::vector<double> mean, chain, share;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      mean.push_back(of(i).squares / of(i).length);
      chain.push_back(of(i).chains / of(i).length);
      share.push_back(of(i).length);
    }
    table_.add(name + "_length_rank", ranks(mean, edges_));
    table_.add(name + "_chain_rank", ranks(chain, edges_));
    table_.add(name + "_share_rank", ranks(share, edges_));
  }

  void styles() {
    m_.styles = numbered([&](std::size_t i) { return style_key(i, 2.5, 6); });
    m_.looks = numbered([&](std::size_t i) { return style_key(i, 1.2, 3); });
    style("style", m_.styles);
    style("look", m_.looks);
  }

  using StyleKey = std::array<int, 5>;
  [[nodiscard]] StyleKey style_key(std::size_t i, double widths, double shades) const {
    const SideView& dark = m_.views[i].dark;
    const auto step = [](double value) { return static_cast<int>(std::lround(value)); };
    return {width_[i] > 0 ? step(widths * std::log2(1 + width_[i])) : -1,
            step(contrast_[i] / range_ * shades), step((dark.near_grey - ground_) / range_ * shades),
            step((dark.red_green - ground_red_green_) / 128 * shades),
            step((dark.yellow_blue - ground_yellow_blue_) / 128 * shades)};
  }
  template <class Key>
  [[nodiscard]] std::vector<int> numbered(Key key) const {
    std::map<StyleKey, int> numbers;
    std::vector<int> style_of;
    for (std::size_t i = 0; i < edges_.size(); ++i)
      style_of.push_back(numbers.try_emplace(key(i), static_cast<int>(numbers.size())).first->second);
    return style_of;
  }

  const EdgeSheet& sheet_;
  EdgeMeasures& m_;
  const std::vector<Edge>& edges_;
  FeatureTable table_;
  std::vector<double> width_, contrast_;
  double total_ = 0, pen_ = 1, range_ = 255;  // how far its darkest and brightest edges reach
  const double ground_ = sheet_.ground.grey, ground_red_green_ = sheet_.ground.red_green,
               ground_yellow_blue_ = sheet_.ground.yellow_blue;
};

}  // namespace

EdgeMeasures measure_edges(const EdgeSheet& sheet) {
  EdgeMeasures measures;
  measures.views = look_across(sheet);
  auto regions = std::async(std::launch::async, [&] { return regions_beside(sheet); });
  measures.links = link_edges(sheet, measures.views);
  measures.regions = regions.get();
  return measures;
}

FeatureTable edge_features(const EdgeSheet& sheet, EdgeMeasures& measures) {
  return Builder(sheet, measures).build();
}

}  // namespace madori::mapping
