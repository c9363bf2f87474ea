#pragma once

#include <cstdint>
#include <string>

#include "mapping/wall_map/wall.hpp"

namespace madori::fuzz {

inline constexpr std::uint64_t kLearnedOn = 77;  ///< checksum of the walls of a memory

/// What was learned is of this room: a screen stands in it.
inline const mapping::Walls& learned_walls() {
  static const mapping::Walls walls{{1, {{0.0, 0.0}, {8.0, 0.0}}},
                                    {2, {{8.0, 0.0}, {8.0, 5.0}}},
                                    {3, {{8.0, 5.0}, {0.0, 5.0}}},
                                    {4, {{0.0, 5.0}, {0.0, 0.0}}},
                                    {5, {{4.0, 0.0}, {4.0, 3.0}}}};
  return walls;
}

/// The first lines of a text.
inline std::string head_of(const std::string& text, int lines) {
  std::size_t end = 0;
  for (int i = 0; i < lines; ++i) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

}  // namespace madori::fuzz
