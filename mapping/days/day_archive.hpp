#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "mapping/days/day_map.hpp"

namespace madori::mapping {

/// The days that a site keeps: DIR/learned/days/2026-11-25.png, one file a day (day_file.hpp).
inline constexpr const char* kDaysFolder = "learned/days";

/// What stays when there are many. With living_map.bin of 100 m x 60 m (at most 6.5 MB) all of it takes less
/// than 20 MB.
struct DayBounds {
  std::size_t daily = 60;                  ///< the newest so many days stay, each
  std::size_t weekly = 104;                ///< of the older ones the last of each week (Monday to Sunday)
  std::uintmax_t most_bytes = 13'000'000;  ///< of all together; the oldest go first
};

/// The days that there are files of, oldest first; what has no such name is left alone.
[[nodiscard]] std::vector<CivilDay> kept_days(const std::filesystem::path& site);
/// Of these days, oldest first, with the bytes of each: those that go. Counted by days kept, not by today's
/// date, so that a clock that is wrong for a day does not thin what is young.
[[nodiscard]] std::vector<CivilDay> days_to_drop(const std::vector<std::pair<CivilDay, std::uintmax_t>>& days,
                                                 const DayBounds& bounds = {});

/// Writes the day's file atomically, over the one that there was of that day, and takes away what goes.
/// Throws Error (disk full, no permission).
void keep_day(const std::filesystem::path& site, const DayMap& map, const DayBounds& bounds = {});
/// Refused, with the file and the reason: no such file, damaged, or of another day than its name says.
[[nodiscard]] Result<DayMap> load_day(const std::filesystem::path& site, CivilDay day);

/// The days of one Map frame, oldest first; what cannot be used is told.
struct LoadedDays {
  std::vector<DayMap> days;
  std::vector<std::string> skipped;  ///< a sentence each
  std::size_t of_other_frames = 0;   ///< before the drawing or its scale was changed
};
/// Those between two days, and these.
[[nodiscard]] LoadedDays load_days(const std::filesystem::path& site, const std::string& frame, CivilDay from,
                                   CivilDay to);
/// All of them without their cells: days and places alone.
[[nodiscard]] LoadedDays list_days(const std::filesystem::path& site, const std::string& frame);

}  // namespace madori::mapping
