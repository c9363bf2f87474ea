#pragma once

#include "sensors/rosbag/bag_bytes.hpp"

namespace madori::sensors::rosbag_bridge {

/// A chunk of a bag as it was before it was packed; `compression` is "none", "lz4" or "bz2". Throws
/// std::runtime_error where it does not have the `bytes` that its header says, or more than 256 MiB: a chunk
/// ends with the first message beyond the recorder's limit (768 KiB, unless told otherwise).
[[nodiscard]] std::vector<std::uint8_t> unpacked(std::vector<std::uint8_t> packed,
                                                 const std::string& compression, std::uint32_t bytes);

}  // namespace madori::sensors::rosbag_bridge
