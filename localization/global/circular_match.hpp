#pragma once

#include <cstddef>
#include <cstdint>

namespace madori::localization {

/// For each of `places` views of 64 bytes and each of its 64 turns: sum over the sections i that `scan` has
/// seen (255 = unseen) of min(|scan[i] - view[(i + turn) mod 64]|, most). `costs` has 64 entries a place.
/// Vectorised with run-time dispatch; integers, the same on every processor.
void circular_match(const std::uint8_t* scan, const std::uint8_t* views, std::size_t places,
                    std::uint8_t most, std::uint16_t* costs);

}  // namespace madori::localization
