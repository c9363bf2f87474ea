#include "mapping/wall_map/wall_fingerprint.hpp"

#include <array>
#include <cstdio>

#include "core/fnv1a.hpp"

namespace madori::mapping {

std::uint64_t walls_checksum(const Walls& walls) {
  Walls places = walls;  // a wall that is judged anew stands where it stood
  for (Wall& wall : places) wall.probability = 1.0;
  return fnv1a(walls_csv(places));
}

std::string walls_fingerprint(const Walls& walls) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx",
                static_cast<unsigned long long>(walls_checksum(walls)));
  return digits.data();
}

}  // namespace madori::mapping
