#pragma once

#include <string>
#include <string_view>

#include "core/result.hpp"
#include "mapping/days/day_map.hpp"

namespace madori::mapping {

/// A day as a PNG of 8-bit grey, a pixel a cell (DayMap::packed), whose first chunk after IHDR is a tEXt
/// chunk: keyword "madori-day", text "1 DATE FRAME CELL_M COLUMN ROW". Every chunk has its CRC-32, so that a
/// damaged file is known. Throws Error where the picture cannot be packed.
[[nodiscard]] std::string day_png(const DayMap& map);

/// Reads it back. Refused, with the reason: no such PNG, cut short, changed, another version, numbers out of
/// range.
[[nodiscard]] Result<DayMap> parse_day(std::string_view png);

}  // namespace madori::mapping
