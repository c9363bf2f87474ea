#pragma once

#include <cmath>
#include <cstdint>

namespace madori::localization {

/// Metres: errors of a drawing persist along a wall for about so long.
inline constexpr double kWallPieceM = 2.0;

/// The cell of that side that a point lies in: what lies in one is one witness, however many points it has.
[[nodiscard]] inline std::uint64_t wall_piece_of(double x_m, double y_m) {
  const auto cell = [](double m) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(m / kWallPieceM)));
  };
  return (std::uint64_t{cell(x_m)} << 32U) | cell(y_m);
}

}  // namespace madori::localization
