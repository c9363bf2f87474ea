#pragma once

#include "sensors/lms1xx/cola.hpp"
#include "sensors/lms1xx/scan_data.hpp"

namespace madori::sensors::lms1xx {

/// `sSN LMDscandata` with its frame; the optional parts behind the channels are absent (zeros).
[[nodiscard]] Bytes encode(Dialect dialect, const ScanData& data);

/// The telegram of a scan that was sent by itself, as the answer to somebody who asks for it. Empty where it
/// is none.
[[nodiscard]] Bytes as_answer(Dialect dialect, std::span<const std::uint8_t> telegram);

}  // namespace madori::sensors::lms1xx
