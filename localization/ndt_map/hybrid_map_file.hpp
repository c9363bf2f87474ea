#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "localization/ndt_map/hybrid_map.hpp"

namespace madori::localization {

/// The map as bytes for a file. Little-endian: "MADORILM", u32 version, u64 checksum of the walls
/// (mapping::walls_checksum), f64 side of a cell, u32 number of cells; a cell: i32 column, i32 row, i64 time
/// of its last look (ns), three f32 layers, and two Gaussians, of what is seen and of what lasts: f32
/// samples, and where there are any, f64 mean x and y, f32 covariance (3), f32 height and its variance; at
/// the end an FNV-1a checksum over all of it. Cells that were only drawn are left out.
[[nodiscard]] std::string hybrid_map_bytes(const HybridMap& map, std::uint64_t walls);

/// A map, and the checksum of the walls on which it lies.
struct KeptHybridMap {
  HybridMap map;
  std::uint64_t walls = 0;
};
/// Reads them back. Refused, with the reason: bytes that are cut short or changed, another version, numbers
/// that are not finite, cells that cannot be (never seen, negative counts or variances), another size of
/// cells, more cells than the options allow.
[[nodiscard]] Result<KeptHybridMap> parse_hybrid_map(std::string_view bytes,
                                                     const HybridMapOptions& options = {});

}  // namespace madori::localization
