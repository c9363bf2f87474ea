#pragma once

#include <cstdint>
#include <filesystem>

namespace madori::app {

struct RoomLimits {
  std::uintmax_t max_bytes = 20'000'000'000;       ///< of the bags of all runs together
  std::uintmax_t max_stop_bytes = 20'000'000'000;  ///< ... of those that are kept around stops
  std::uintmax_t min_free_bytes = 2'000'000'000;   ///< on the disk: orders and events need it too
};

/// Removes the oldest bags beyond the limits; the two newest of `run` stay. Where `run` lies in a folder
/// `runs`, all runs in it share the limits, and runs of which nothing is left go too. First the ordinary
/// bags, then those below stops/.
void make_room(const std::filesystem::path& run, const RoomLimits& limits);

}  // namespace madori::app
