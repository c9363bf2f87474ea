#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "localization/wall_reliability/wall_reliability.hpp"

namespace madori::app {

/// A picture (PNG bytes) of what is known of every piece of drawn wall: confirmed (thick), missing (dashed
/// and crossed), displaced (thin where it is drawn, thick where it stands, joined) or unseen (pale). The
/// states differ in shape, not in colour alone.
[[nodiscard]] std::vector<std::uint8_t> reliability_plot(const mapping::Walls& walls,
                                                         const localization::WallReliability& reliability);

/// Metres of wall by state: {"confirmed_m": ..., "missing_m": ..., "displaced_m": ..., "unseen_m": ...}.
[[nodiscard]] nlohmann::json to_json(const localization::WallReliability& reliability);

}  // namespace madori::app
