#pragma once

#include <cstdlib>

#include "sensors/lms1xx/encode.hpp"

namespace madori::sensors::lms1xx {

inline void require(bool good) {
  if (!good) std::abort();
}

/// A TCP stream in two pieces, and the same bytes as one payload. What is accepted must survive its own
/// encoder.
inline int fuzz_cola(Dialect dialect, std::span<const std::uint8_t> bytes) {
  Splitter splitter(dialect);
  const auto check = [dialect](std::span<const std::uint8_t> payload) {
    if (const auto head = head_of(payload)) (void)first_argument(dialect, *head);
    const auto data = decode_scan(dialect, payload);
    if (!data) return;
    if (const auto scan = to_laser_scan(data.value())) {
      for (const float range_m : scan.value().ranges_m) require(range_m > 0.0F);
    }
    const Bytes again = encode(dialect, data.value());
    Splitter other(dialect);
    other.push(again);
    const auto found = other.next();
    // In text a channel name may hold any byte but a blank; the frame's own marks end it.
    if (!found) return;
    const auto twice = decode_scan(dialect, *found);
    if (twice) require(encode(dialect, twice.value()) == again);
    if (dialect == Dialect::B) require(twice.ok());
  };
  check(bytes);
  for (const auto piece : {bytes.first(bytes.size() / 2), bytes.subspan(bytes.size() / 2)}) {
    splitter.push(piece);
    while (const auto payload = splitter.next()) check(*payload);
  }
  return 0;
}

}  // namespace madori::sensors::lms1xx
