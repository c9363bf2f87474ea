#include "mapping/drawing/labelling/sheet_context.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <numeric>
#include <string>

#include "mapping/drawing/labelling/log_odds.hpp"
#include "mapping/drawing/pixel_box.hpp"

namespace madori::mapping {
namespace {

constexpr double kLeastUncertain = 1e-4;  // of every judgement
constexpr double kSmallStyle = 0.01;      // of all length: less is too little to compare with

double entropy(double p) {
  const double a = std::max(p, 1e-6), b = std::max(1 - p, 1e-6);
  return -(p * std::log(a) + (1 - p) * std::log(b));
}

/// Length-weighted sums over a group of edges.
struct Sums {
  double length = 0, walls = 0, squares = 0, odds = 0, probable = 0;
  [[nodiscard]] double mean() const { return walls / length; }
  [[nodiscard]] double spread() const { return std::sqrt(std::max(0.0, squares / length - mean() * mean())); }
};

class Context {
 public:
  Context(const std::vector<PixelSegment>& edges, const EdgeGroups& groups, const std::vector<float>& p)
      : edges_(edges), groups_(groups), p_(p), table_(edges.size()) {
    for (const PixelSegment& edge : edges) length_.push_back(std::max(1e-6, edge.length_px()));
    total_ = std::accumulate(length_.begin(), length_.end(), 0.0);
  }

  FeatureTable build() {
    Context rest(*this);  // on another thread, into a table of its own
    auto beside = std::async(std::launch::async, [&] {
      rest.around("near", 0.03);
      rest.around("area", 0.1);
    });
    whole_sheet();
    const std::array<std::string, 4> names{"style", "look", "chain", "cluster"};
    for (std::size_t k = 0; k < names.size(); ++k) group(names[k], groups_.together[k], k < 2);
    for (std::size_t k = 0; k < 2; ++k)
      add(k == 0 ? "over_dark" : "over_bright", [&](std::size_t i) {
        const int partner = groups_.partner[k][i];
        return partner < 0 ? -1.0 : p_[static_cast<std::size_t>(partner)];
      });
    beside.get();
    table_.add(rest.table_);
    return std::move(table_);
  }

 private:
  template <class Value>
  void add(const std::string& name, Value value) {
    table_.fill("first_" + name, value);
  }

  void whole_sheet() {
    std::vector<std::size_t> order(edges_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_[a] > p_[b]; });
    std::vector<double> above(edges_.size());
    double sum = 0;
    for (const std::size_t i : order) above[i] = (sum += length_[i]) / total_;
    add("odds", [&](std::size_t i) { return log_odds(p_[i], kLeastUncertain); });
    add("above", [&](std::size_t i) { return above[i]; });
    const auto quantile = [&](double share) {
      const auto at =
          std::find_if(order.begin(), order.end(), [&](std::size_t i) { return above[i] >= share; });
      return order.empty() ? 0.0 : p_[at == order.end() ? order.back() : *at];
    };
    for (const double share : {0.02, 0.05, 0.1, 0.2, 0.35, 0.5}) {
      const double level = quantile(share);
      const std::string percent = std::to_string(std::lround(100 * share));
      add("sheet_" + percent, [&](std::size_t) { return level; });
      if (share > 0.04 && share < 0.3)
        add("over_sheet_" + percent, [&](std::size_t i) { return p_[i] / std::max(1e-3, level); });
    }
    const auto mean_of = [&](auto value) {
      double weighed = 0;
      for (std::size_t i = 0; i < edges_.size(); ++i) weighed += length_[i] * value(p_[i]) / total_;
      return weighed;
    };
    for (const auto& [name, value] :
         {std::pair{"sheet_mean", mean_of([](double p) { return p; })},
          std::pair{"sheet_doubt", mean_of(entropy)},
          std::pair{"sheet_above_20", mean_of([](double p) { return p > 0.2 ? 1.0 : 0.0; })},
          std::pair{"sheet_above_50", mean_of([](double p) { return p > 0.5 ? 1.0 : 0.0; })},
          std::pair{"sheet_above_80", mean_of([](double p) { return p > 0.8 ? 1.0 : 0.0; })}})
      add(name, [constant = value](std::size_t) { return constant; });
  }

  template <class Key>
  [[nodiscard]] std::map<Key, Sums> summed(const std::vector<Key>& group_of) const {
    std::map<Key, Sums> sums;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      Sums& of = sums[group_of[i]];
      const double length = length_[i], p = p_[i];
      of.length += length;
      of.walls += length * p;
      of.squares += length * p * p;
      of.odds += length * log_odds(p, kLeastUncertain);
      of.probable += p > 0.5 ? length : 0;
    }
    return sums;
  }

  void group(const std::string& name, const std::vector<int>& group_of, bool styles) {
    const auto sums = summed(group_of);
    const auto of = [&](std::size_t i) -> const Sums& { return sums.at(group_of[i]); };
    add(name + "_mean", [&](std::size_t i) { return of(i).mean(); });
    add(name + "_spread", [&](std::size_t i) { return of(i).spread(); });
    add(name + "_share", [&](std::size_t i) { return of(i).length / total_; });
    add(name + "_probable", [&](std::size_t i) { return of(i).probable / of(i).length; });
    add(name + "_odds", [&](std::size_t i) { return of(i).odds / of(i).length; });
    if (!styles) return;
    double most = 0, best = 0;
    for (const auto& [key, s] : sums) {
      most = std::max(most, s.walls);
      if (s.length > kSmallStyle * total_) best = std::max(best, s.mean());
    }
    add(name + "_of_most", [&](std::size_t i) { return of(i).walls / std::max(1e-9, most); });
    add(name + "_of_best", [&](std::size_t i) { return best > 0 ? of(i).mean() / best : of(i).mean(); });
    add(name + "_rank", [rank = ranks(sums, group_of)](std::size_t i) { return rank[i]; });
  }

  /// How much of the sheet lies in groups that are at least as probable.
  [[nodiscard]] std::vector<double> ranks(const std::map<int, Sums>& sums,
                                          const std::vector<int>& group_of) const {
    std::vector<std::pair<double, int>> order;
    for (const auto& [key, s] : sums) order.emplace_back(-s.mean(), key);
    std::sort(order.begin(), order.end());
    std::map<int, double> rank;
    double sum = 0;
    for (const auto& [mean, key] : order) rank[key] = (sum += sums.at(key).length) / total_;
    std::vector<double> result;
    for (const int key : group_of) result.push_back(rank.at(key));
    return result;
  }

  /// The judgement of all that lies in the same cell of a coarse grid.
  void around(const std::string& name, double cell_share) {
    PixelBox box;
    for (const PixelSegment& s : edges_) box.add(s);
    const double cell = std::max(1e-3, cell_share * std::max(box.width(), box.height()));
    std::vector<std::pair<int, int>> cell_of;
    for (const PixelSegment& s : edges_)
      cell_of.emplace_back(static_cast<int>((0.5 * (s.u1 + s.u2) - box.left) / cell),
                           static_cast<int>((0.5 * (s.v1 + s.v2) - box.top) / cell));
    const auto sums = summed(cell_of);
    add(name + "_mean", [&](std::size_t i) { return sums.at(cell_of[i]).mean(); });
    add(name + "_probable",
        [&](std::size_t i) { return sums.at(cell_of[i]).probable / sums.at(cell_of[i]).length; });
  }

  const std::vector<PixelSegment>& edges_;
  const EdgeGroups& groups_;
  const std::vector<float>& p_;
  FeatureTable table_;
  std::vector<double> length_;
  double total_ = 0;
};

}  // namespace

FeatureTable sheet_context(const std::vector<PixelSegment>& edges, const EdgeGroups& groups,
                           const std::vector<float>& probabilities) {
  return Context(edges, groups, probabilities).build();
}

}  // namespace madori::mapping
