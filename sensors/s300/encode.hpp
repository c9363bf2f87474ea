#pragma once

#include <cstdint>
#include <vector>

#include "sensors/s300/telegram.hpp"

namespace madori::sensors::s300 {

/// The telegram's bytes, which Stream reads back. Precondition: at most kMaxValues values.
[[nodiscard]] std::vector<std::uint8_t> encode(const Telegram& telegram);

}  // namespace madori::sensors::s300
