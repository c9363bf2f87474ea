#pragma once

#include <optional>
#include <string>

#include "core/stamp.hpp"
#include "localization/ndt_map/hybrid_map.hpp"
#include "mapping/days/day_map.hpp"

namespace madori::app {

/// What a living map reads now, for the day of its newest look. `frame`: mapping::map_frame() of its site;
/// `labels`: the time of day less the clock's time (core/clock.hpp), so that a clock that was set while the
/// program ran does not put looks on another day. Nothing where nothing was seen. Throws Error where what was
/// seen is farther apart than a day can hold.
[[nodiscard]] std::optional<mapping::DayMap> day_of(const localization::HybridMap& map,
                                                    const std::string& frame, Duration labels);

}  // namespace madori::app
