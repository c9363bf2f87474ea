#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::mapping {

/// A day of the civil calendar, UTC.
using CivilDay = std::chrono::sys_days;
/// As 2026-11-25.
[[nodiscard]] std::string to_text(CivilDay day);
/// Nothing for any text of another form, and for a date that no calendar has.
[[nodiscard]] std::optional<CivilDay> civil_day(std::string_view text);

/// What the living map read of a cell at the end of a day (docs/explanation/living-map.md). The numbers stand
/// in the files.
enum class DayState : std::uint8_t { Unseen, Free, Moving, SemiStatic, Static, TakenAway };

[[nodiscard]] constexpr bool stands(DayState state) {
  return state == DayState::Static || state == DayState::SemiStatic;
}
[[nodiscard]] constexpr bool is_free(DayState state) {
  return state == DayState::Free || state == DayState::TakenAway;
}

struct DayCell {
  DayState state = DayState::Unseen;
  int age_days = 0;  ///< civil days since its last look; kOldestDays also stands for more

  friend bool operator==(const DayCell&, const DayCell&) = default;
};
inline constexpr int kOldestDays = 41;  ///< so that state and age share one byte: 6 x 42 values

/// The living map as it read at the end of one day: square cells of the Map frame, cell (0, 0) with its
/// lower-left corner at the frame's origin. Cells outside are unseen.
class DayMap {
 public:
  /// What is kept at most; 600 m x 200 m at 0.25 m. All days that are kept together then take 330 MB of
  /// memory where two of them are compared.
  static constexpr std::int64_t kMostCells = 2'000'000;

  CivilDay day{};
  std::string frame;  ///< map_frame() of the site: days of another frame are not compared
  double cell_m = 0.25;
  int column = 0;  ///< of the lower-left cell
  int row = 0;
  int width = 0;  ///< in cells
  int height = 0;
  std::vector<std::uint8_t> packed;  ///< state * 42 + age, a byte a cell, rows from the top as in a picture

  /// Unseen, width x height. Precondition: 0 < width * height <= kMostCells.
  void resize(int columns, int rows);
  [[nodiscard]] DayCell at(int at_column, int at_row) const;
  /// Precondition: the cell lies inside.
  void set(int at_column, int at_row, DayCell cell);
  [[nodiscard]] Point2<Map> centre(int at_column, int at_row) const {
    return {(at_column + 0.5) * cell_m, (at_row + 0.5) * cell_m};
  }

 private:
  [[nodiscard]] std::size_t index(int at_column, int at_row) const {
    return static_cast<std::size_t>(row + height - 1 - at_row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(at_column - column);
  }
};

}  // namespace madori::mapping
