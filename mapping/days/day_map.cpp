#include "mapping/days/day_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace madori::mapping {
namespace {

constexpr int kAges = kOldestDays + 1;

std::optional<int> digits(std::string_view text) {
  int value = 0;
  const auto all = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!all) return std::nullopt;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::string to_text(CivilDay day) {
  const std::chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

std::optional<CivilDay> civil_day(std::string_view text) {
  constexpr std::size_t kLength = 10;
  if (text.size() != kLength || text[4] != '-' || text[7] != '-') return std::nullopt;
  const auto year = digits(text.substr(0, 4)), month = digits(text.substr(5, 2)),
             day = digits(text.substr(8, 2));
  if (!year || !month || !day) return std::nullopt;
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) return std::nullopt;
  return CivilDay(date);
}

void DayMap::resize(int columns, int rows) {
  width = columns;
  height = rows;
  packed.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
}

DayCell DayMap::at(int at_column, int at_row) const {
  if (at_column < column || at_row < row || at_column >= column + width || at_row >= row + height) return {};
  const int value = packed[index(at_column, at_row)];
  return {static_cast<DayState>(value / kAges), value % kAges};
}

void DayMap::set(int at_column, int at_row, DayCell cell) {
  const int age = std::clamp(cell.age_days, 0, kOldestDays);
  packed[index(at_column, at_row)] = static_cast<std::uint8_t>(static_cast<int>(cell.state) * kAges + age);
}

}  // namespace madori::mapping
