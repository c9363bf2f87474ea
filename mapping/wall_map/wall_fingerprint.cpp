#include "mapping/wall_map/wall_fingerprint.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

namespace madori::mapping {

std::string walls_fingerprint(const Walls& walls) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char c : walls_csv(walls)) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash));
  return digits.data();
}

}  // namespace madori::mapping
