#include "mapping/days/day_clusters.hpp"

#include <algorithm>
#include <set>

namespace madori::mapping {
namespace {

constexpr int kGap = 2;  // cells: a lidar does not meet each cell of a face, so one may lack between two

bool has_vanished(const DayMap& before, const DayMap& now, const DayPlace& p) {
  return stands(before.at(p.column, p.row).state) && is_free(now.at(p.column, p.row).state);
}

/// The cells of a square of side 2 * reach + 1 around a place, itself left out.
template <class Do>
void around(const DayPlace& p, int reach, Do visit) {
  for (int row = p.row - reach; row <= p.row + reach; ++row)
    for (int column = p.column - reach; column <= p.column + reach; ++column)
      if (column != p.column || row != p.row) visit(DayPlace{column, row});
}

/// Whether all that is beside a place was seen, and nothing stands there.
bool is_open(const DayMap& now, const DayPlace& p) {
  bool open = true;
  around(p, 1, [&](const DayPlace& n) {
    const DayState state = now.at(n.column, n.row).state;
    open = open && state != DayState::Unseen && !stands(state);
  });
  return open;
}

std::set<DayPlace> surely_vanished(const DayMap& before, const DayMap& now) {
  std::set<DayPlace> sure;
  for (int row = before.row; row < before.row + before.height; ++row)
    for (int column = before.column; column < before.column + before.width; ++column) {
      const DayPlace p{column, row};
      if (has_vanished(before, now, p) && is_open(now, p)) sure.insert(p);
    }
  return sure;
}

/// Takes a cell and all that are joined to it out of `left`.
std::vector<DayPlace> take_joined(std::set<DayPlace>& left) {
  std::vector<DayPlace> joined{*left.begin()};
  left.erase(left.begin());
  for (std::size_t i = 0; i < joined.size(); ++i) {
    const DayPlace p = joined[i];
    around(p, kGap, [&](const DayPlace& n) {
      if (left.erase(n) > 0) joined.push_back(n);
    });
  }
  return joined;
}

void add_rim(const DayMap& before, const DayMap& now, std::vector<DayPlace>& cells) {
  std::set<DayPlace> all(cells.begin(), cells.end());
  for (const DayPlace& p : cells)
    around(p, 1, [&](const DayPlace& n) {
      if (has_vanished(before, now, n)) all.insert(n);
    });
  cells.assign(all.begin(), all.end());
}

DayCluster measured(const DayMap& map, std::vector<DayPlace> cells) {
  DayCluster cluster;
  DayPlace low = cells.front(), high = cells.front();
  for (const DayPlace& p : cells) {
    const Point2<Map> middle = map.centre(p.column, p.row);
    cluster.centre.x_m += middle.x_m / static_cast<double>(cells.size());
    cluster.centre.y_m += middle.y_m / static_cast<double>(cells.size());
    low = {std::min(low.column, p.column), std::min(low.row, p.row)};
    high = {std::max(high.column, p.column), std::max(high.row, p.row)};
  }
  cluster.width_m = (high.column - low.column + 1) * map.cell_m;
  cluster.height_m = (high.row - low.row + 1) * map.cell_m;
  cluster.cells = std::move(cells);
  return cluster;
}

}  // namespace

std::vector<DayCluster> vanished(const DayMap& before, const DayMap& now) {
  std::vector<DayCluster> clusters;
  std::set<DayPlace> left = surely_vanished(before, now);
  while (!left.empty()) {
    std::vector<DayPlace> cells = take_joined(left);
    if (cells.size() < kLeastCells) continue;
    add_rim(before, now, cells);
    clusters.push_back(measured(before, std::move(cells)));
  }
  return clusters;
}

}  // namespace madori::mapping
