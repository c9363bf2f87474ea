#include "mapping/days/day_archive.hpp"

#include <algorithm>
#include <map>

#include "mapping/days/day_file.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

fs::path file_of(const fs::path& site, CivilDay day) {
  return site / kDaysFolder / (to_text(day) + ".png");
}

/// The Monday of its week.
CivilDay week_of(CivilDay day) {
  return day - (std::chrono::weekday(day) - std::chrono::Monday);
}

void take(Result<DayMap> read, const std::string& frame, LoadedDays& loaded) {
  if (!read.ok())
    loaded.skipped.push_back(read.reason());
  else if (read.value().frame != frame)
    ++loaded.of_other_frames;
  else
    loaded.days.push_back(std::move(read).value());
}

}  // namespace

std::vector<CivilDay> kept_days(const fs::path& site) {
  std::vector<CivilDay> days;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(site / kDaysFolder, missing)) {
    if (entry.path().extension() != ".png" || !entry.is_regular_file(missing)) continue;
    if (const auto day = civil_day(entry.path().stem().string())) days.push_back(*day);
  }
  std::ranges::sort(days);
  return days;
}

std::vector<CivilDay> days_to_drop(const std::vector<std::pair<CivilDay, std::uintmax_t>>& days,
                                   const DayBounds& bounds) {
  const std::size_t older = days.size() - std::min(days.size(), bounds.daily);
  std::map<CivilDay, std::size_t> last_of_week;
  for (std::size_t i = 0; i < older; ++i) last_of_week[week_of(days[i].first)] = i;
  while (last_of_week.size() > bounds.weekly) last_of_week.erase(last_of_week.begin());
  std::vector<CivilDay> drop;
  std::uintmax_t bytes = 0;
  for (std::size_t i = days.size(); i-- > 0;) {  // the newest are counted first
    const auto& [day, size] = days[i];
    const auto week = last_of_week.find(week_of(day));
    const bool stays = i >= older || (week != last_of_week.end() && week->second == i);
    if (stays && bytes + size <= bounds.most_bytes)
      bytes += size;
    else
      drop.push_back(day);
  }
  std::ranges::reverse(drop);
  return drop;
}

void keep_day(const fs::path& site, const DayMap& map, const DayBounds& bounds) {
  fs::create_directories(site / kDaysFolder);
  write_file_atomically(file_of(site, map.day), day_png(map));
  std::vector<std::pair<CivilDay, std::uintmax_t>> days;
  std::error_code missing;
  for (const CivilDay day : kept_days(site))
    days.emplace_back(day, fs::file_size(file_of(site, day), missing));
  for (const CivilDay day : days_to_drop(days, bounds)) fs::remove(file_of(site, day), missing);
}

Result<DayMap> load_day(const fs::path& site, CivilDay day) {
  const std::string name = std::string(kDaysFolder) + "/" + to_text(day) + ".png";
  const std::string bytes = file_content(site / name);
  if (bytes.empty()) return Result<DayMap>::failure(name + ": there is no such file");
  auto read = parse_day(bytes);
  if (!read.ok()) return Result<DayMap>::failure(name + ": " + read.reason());
  if (read.value().day != day) return Result<DayMap>::failure(name + ": it is of another day");
  return read;
}

LoadedDays load_days(const fs::path& site, const std::string& frame, CivilDay from, CivilDay to) {
  LoadedDays loaded;
  for (const CivilDay day : kept_days(site))
    if (day >= from && day <= to) take(load_day(site, day), frame, loaded);
  return loaded;
}

LoadedDays list_days(const fs::path& site, const std::string& frame) {
  LoadedDays listed;
  for (const CivilDay day : kept_days(site)) {
    take(load_day(site, day), frame, listed);
    if (!listed.days.empty()) listed.days.back().packed = {};
  }
  return listed;
}

}  // namespace madori::mapping
