#pragma once

#include <filesystem>
#include <memory>

#include "sensors/open_log.hpp"

namespace madori::sensors::pcap {

/// Opens a capture of one VLP-16: its revolutions, with the wheels' odometry in between, in the order of
/// time. Throws Error, here or while it is read, where it holds no packet of one, or those of several.
[[nodiscard]] std::unique_ptr<LogReader> open_vlp16_log(const std::filesystem::path& file,
                                                        const LogOptions& options);

}  // namespace madori::sensors::pcap
