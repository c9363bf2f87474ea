#pragma once

#include "sensors/lms1xx/cola.hpp"
#include "sensors/lms1xx/scan_data.hpp"

namespace madori::sensors::lms1xx {

/// `sSN LMDscandata` with its frame; the optional parts behind the channels are absent (zeros).
[[nodiscard]] Bytes encode(Dialect dialect, const ScanData& data);

}  // namespace madori::sensors::lms1xx
