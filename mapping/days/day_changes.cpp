#include "mapping/days/day_changes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace madori::mapping {
namespace {

using Days = std::span<const DayMap>;
using Reads = bool (*)(DayState);

// What is taken for the same thing in another place.
constexpr double kFarthestM = 3.0;   ///< between the centres
constexpr double kCellsRatio = 0.5;  ///< of the smaller to the larger: another side of it may be seen there
constexpr double kExtentM = 0.5;  ///< two cells: the boxes' longer and shorter sides may differ by this ...
constexpr double kExtentShare = 0.3;  ///< ... or this share of the longer box's, where that is more

bool are_alike(double a_m, double b_m) {
  return std::abs(a_m - b_m) <= std::max(kExtentM, kExtentShare * std::max(a_m, b_m));
}

bool may_be_same(const DayCluster& gone, const DayCluster& added) {
  const auto [few, many] = std::minmax({gone.cells.size(), added.cells.size()});
  const auto [gone_short, gone_long] = std::minmax({gone.width_m, gone.height_m});
  const auto [added_short, added_long] = std::minmax({added.width_m, added.height_m});
  return distance_m(gone.centre, added.centre) <= kFarthestM &&
         static_cast<double>(few) >= kCellsRatio * static_cast<double>(many) &&
         are_alike(gone_long, added_long) && are_alike(gone_short, added_short);
}

/// Whether at least half of the cells read so.
bool most(const DayMap& day, const DayCluster& cluster, Reads reads) {
  const auto count = std::ranges::count_if(
      cluster.cells, [&](const DayPlace& p) { return reads(day.at(p.column, p.row).state); });
  return 2 * static_cast<std::size_t>(count) >= cluster.cells.size();
}

/// The newest look at a cell that reads so.
CivilDay last_look(const DayMap& day, const DayCluster& cluster, Reads reads) {
  int age_days = kOldestDays;
  for (const DayPlace& p : cluster.cells) {
    const DayCell cell = day.at(p.column, p.row);
    if (reads(cell.state)) age_days = std::min(age_days, cell.age_days);
  }
  return day.day - std::chrono::days(age_days);
}

struct Dates {
  CivilDay before, since;
};

/// The first day reads all cells as `was`, the last one as `is`.
Dates dates_of(Days days, const DayCluster& cluster, Reads was, Reads is) {
  std::size_t before = 0;
  for (std::size_t i = 0; i < days.size(); ++i)
    if (most(days[i], cluster, was)) before = i;
  std::size_t since = std::min(before + 1, days.size() - 1);
  while (since + 1 < days.size() && !most(days[since], cluster, is)) ++since;
  return {last_look(days[before], cluster, was), days[since].day};
}

DayChange change_of(ChangeKind kind, const DayCluster& cluster, const Dates& dates) {
  return {kind,         cluster.centre, cluster.width_m, cluster.height_m, cluster.cells.size(),
          std::nullopt, dates.before,   dates.since};
}

/// The nearest pairs first; each cluster belongs to one pair at most.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const std::vector<DayCluster>& gone,
                                                          const std::vector<DayCluster>& added) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;
  for (std::size_t i = 0; i < gone.size(); ++i)
    for (std::size_t j = 0; j < added.size(); ++j)
      if (may_be_same(gone[i], added[j]))
        near.emplace_back(distance_m(gone[i].centre, added[j].centre), i, j);
  std::ranges::sort(near);
  std::vector<bool> gone_taken(gone.size()), added_taken(added.size());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [distance, i, j] : near) {
    if (gone_taken[i] || added_taken[j]) continue;
    gone_taken[i] = added_taken[j] = true;
    pairs.emplace_back(i, j);
  }
  return pairs;
}

}  // namespace

std::vector<DayChange> changes_between(Days days) {
  if (days.size() < 2) return {};
  const auto gone = vanished(days.front(), days.back());
  const auto added = vanished(days.back(), days.front());
  std::vector<DayChange> went, came;
  for (const auto& c : gone)
    went.push_back(change_of(ChangeKind::Gone, c, dates_of(days, c, stands, is_free)));
  for (const auto& c : added)
    came.push_back(change_of(ChangeKind::New, c, dates_of(days, c, is_free, stands)));
  for (const auto& [i, j] : pairs_of(gone, added)) {
    came[j].kind = ChangeKind::Moved;
    came[j].from = went[i].centre;
    came[j].before = went[i].before;
    went[i].cells = 0;  // told by what moved
  }
  std::vector<DayChange> changes;
  for (auto* list : {&went, &came})
    std::ranges::copy_if(*list, std::back_inserter(changes), [](const DayChange& c) { return c.cells > 0; });
  std::ranges::stable_sort(changes, std::greater<>(), &DayChange::cells);
  return changes;
}

}  // namespace madori::mapping
