#include "app/learned/day_of_map.hpp"

#include "app/learned/seen_box.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

using localization::CellState;
using localization::CellTree;
using mapping::DayState;

mapping::CivilDay civil_day_of(Stamp stamp) {
  return std::chrono::floor<std::chrono::days>(stamp);
}

/// By name: what stands in files must not follow the order of the map's own states.
DayState state_of(CellState state) {
  switch (state) {
    case CellState::Unseen:
      return DayState::Unseen;
    case CellState::Free:
      return DayState::Free;
    case CellState::Moving:
      return DayState::Moving;
    case CellState::SemiStatic:
      return DayState::SemiStatic;
    case CellState::Static:
      return DayState::Static;
    case CellState::TakenAway:
      return DayState::TakenAway;
  }
  return DayState::Unseen;
}

}  // namespace

std::optional<mapping::DayMap> day_of(const localization::HybridMap& map, const std::string& frame,
                                      Duration labels) {
  const SeenBox box = seen_box(map);
  if (box.empty()) return std::nullopt;
  if (box.cells() > mapping::DayMap::kMostCells)
    throw Error("the living map", "reaches farther than a day's map can",
                "the vehicle has believed wrong places: remove it");
  mapping::DayMap day;
  day.day = civil_day_of(map.newest() + labels);
  day.frame = frame;
  day.cell_m = map.options().cell_m;
  day.column = box.low.column;
  day.row = box.low.row;
  day.resize(box.width(), box.height());
  const CellTree& cells = map.cells();
  for (CellTree::Index i = 0; i < cells.size(); ++i) {
    const auto& layers = cells[i].layers;
    if (!layers.was_seen()) continue;
    const auto age = day.day - civil_day_of(layers.seen + labels);
    const localization::CellPlace& p = cells.place(i);
    day.set(p.column, p.row, {state_of(map.state(i)), static_cast<int>(age.count())});
  }
  return day;
}

}  // namespace madori::app
