#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "mapping/site/site.hpp"
#include "simulation/scenario/scenario.hpp"
#include "tests/support/hand_drive.hpp"

namespace madori::test {

/// A random drive by hand through the two rooms of data/two_rooms; metres, Map frame of its true walls.
struct MappingTrial {
  std::uint64_t seed = 1;
  mapping::SensorRecord lidar{"top", "vlp16", 0.3, 0.0, 1.2, 0.0};
  int keep_every_firing = 1;     ///< of a VLP-16; 4: a quarter of the firings
  int persons = 0;               ///< who walk about in the rooms
  std::filesystem::path keep{};  ///< copies the site and the drive there; empty: not
};

/// A piece of a mapped wall that lies where no wall is, on the true building.
struct PhantomPiece {
  Segment2<Map> where;
  double off_m = 0.0;  ///< of its farthest place from the nearest true wall
};

struct MappingTrialResult {
  int missed = 0;  ///< goals given up: somebody or a corner was in the way
  double driven_m = 0.0;
  std::size_t keyframes = 0, walls = 0;
  double map_to_building_m = 0.0;  ///< mean, as `madori evaluate --map --align anywhere`
  double building_to_map_m = 0.0;
  std::vector<PhantomPiece> phantoms;  ///< of places farther than 0.1 m from every true wall
  double finish_s = 0.0;               ///< that the last look and the walls took, wall clock
};

/// The site's walls beside those of data/two_rooms, as `madori evaluate --map --align anywhere` compares
/// them.
[[nodiscard]] nlohmann::json compared_with_rooms(const std::filesystem::path& site);

/// Drives, finishes the map, scores it. Deterministic but for finish_s.
[[nodiscard]] MappingTrialResult run_mapping_trial(const MappingTrial& trial);

}  // namespace madori::test
