#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/buildings/bent_trial.hpp"

namespace madori::bench {

/// Many random bent buildings: `count` seeds from `first_seed` on, each at every amplitude with every sensor.
struct BentCampaign {
  int count = 0;
  std::uint32_t first_seed = 1001;  ///< constants are chosen on seeds below 1001
  std::vector<double> amplitudes_m{0.1, 0.3, 0.6, 1.0};
  std::vector<std::string> sensors{"vlp16", "scan"};
  BentTrialOptions trial;
  std::filesystem::path samples_file;
};

/// Drives all of them in `jobs` processes and prints the table; the JSON file gets the trials without their
/// samples. 1 where a drive could not be made at all.
[[nodiscard]] int drive_bent_buildings(const BentCampaign& campaign, int jobs,
                                       const std::filesystem::path& json_file);

}  // namespace madori::bench
