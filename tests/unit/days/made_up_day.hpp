#pragma once

#include <string>
#include <vector>

#include "mapping/days/day_map.hpp"

namespace madori::test {

inline constexpr const char* kMadeUpFrame = "0123456789abcdef";

/// A day drawn with letters, rows from the top: '#' static, 's' semi-static, 'm' moving, 't' taken away,
/// '.' free, ' ' unseen. All were looked at on the day. The lower-left cell is (-2, 3).
inline mapping::DayMap made_up_day(const std::string& date, const std::vector<std::string>& rows) {
  mapping::DayMap map;
  map.day = *mapping::civil_day(date);
  map.frame = kMadeUpFrame;
  map.column = -2;
  map.row = 3;
  map.resize(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  const std::string letters = " .ms#t";  // in the states' order
  for (int v = 0; v < map.height; ++v)
    for (int u = 0; u < map.width; ++u) {
      const auto state = letters.find(rows[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)]);
      map.set(map.column + u, map.row + map.height - 1 - v, {static_cast<mapping::DayState>(state), 0});
    }
  return map;
}

}  // namespace madori::test
