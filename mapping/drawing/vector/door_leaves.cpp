#include "mapping/drawing/vector/door_leaves.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {
namespace {

constexpr double kReach = 0.12;  // radii: the leaf is that thick, and hangs in a frame
constexpr double kLikeSize = 2;  // to the median radius, up or down

double distance(const DxfPoint& p, double x, double y) {
  return std::hypot(p.x - x, p.y - y);
}

bool is_leaf(const DxfLine& line, const DoorSwing& swing) {
  const double reach = kReach * swing.radius;
  if (std::abs(line.length() - swing.radius) > reach) return false;
  const bool forward = distance(swing.hinge, line.x1, line.y1) < distance(swing.hinge, line.x2, line.y2);
  const double hinge_x = forward ? line.x1 : line.x2, hinge_y = forward ? line.y1 : line.y2;
  const double tip_x = forward ? line.x2 : line.x1, tip_y = forward ? line.y2 : line.y1;
  return distance(swing.hinge, hinge_x, hinge_y) <= reach &&
         std::min(distance(swing.from, tip_x, tip_y), distance(swing.to, tip_x, tip_y)) <= reach;
}

/// Those of about the common size, by the x of their hinges.
std::vector<DoorSwing> doors_of(std::vector<DoorSwing> swings) {
  const auto middle = swings.begin() + static_cast<std::ptrdiff_t>(swings.size() / 2);
  std::ranges::nth_element(swings, middle, {}, &DoorSwing::radius);
  const double typical = middle->radius;
  std::erase_if(swings, [typical](const DoorSwing& s) {
    return s.radius > kLikeSize * typical || kLikeSize * s.radius < typical;
  });
  std::ranges::sort(swings, {}, [](const DoorSwing& s) { return s.hinge.x; });
  return swings;
}

/// Calls visit(line, door) for every line that is the leaf of a door; the doors by the x of their hinges.
template <class Visit>
void for_leaves(const std::vector<DxfLine>& lines, const std::vector<DoorSwing>& doors, Visit visit) {
  const double reach = kReach * std::ranges::max_element(doors, {}, &DoorSwing::radius)->radius;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const double x : {lines[i].x1, lines[i].x2}) {
      auto door =
          std::ranges::lower_bound(doors, x - reach, {}, [](const DoorSwing& s) { return s.hinge.x; });
      for (; door != doors.end() && door->hinge.x <= x + reach; ++door)
        if (is_leaf(lines[i], *door)) visit(i, static_cast<std::size_t>(door - doors.begin()));
    }
  }
}

}  // namespace

void mark_door_leaves(std::vector<DxfLine>& lines, const std::vector<DoorSwing>& swings) {
  if (swings.empty()) return;
  for_leaves(lines, doors_of(swings), [&](std::size_t line, std::size_t) { lines[line].door_leaf = true; });
}

void mark_doors_ajar(std::vector<DxfLine>& lines, const std::vector<DoorSwing>& arcs) {
  if (arcs.empty()) return;
  const auto doors = doors_of(arcs);
  for_leaves(lines, doors, [&](std::size_t line, std::size_t door) {
    const DoorSwing& arc = doors[door];
    if (line >= arc.first_line && line < arc.end_line) return;
    lines[line].door_leaf = true;
    for (std::size_t i = arc.first_line; i < arc.end_line; ++i) lines[i].door_leaf = true;
  });
}

}  // namespace madori::mapping
