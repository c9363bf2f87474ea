#pragma once

#include <cstdint>
#include <filesystem>

namespace madori::app {

struct RoomLimits {
  std::uintmax_t max_bytes = 20'000'000'000;       ///< of the bags of all runs together
  std::uintmax_t max_stop_bytes = 20'000'000'000;  ///< ... of those that are kept around stops
  std::uintmax_t min_free_bytes = 2'000'000'000;   ///< on the disk: orders and events need it too
};

/// The number in NNN.bag or NNN.bag.active; -1 for other names. After 999 a fourth digit comes: by their
/// names they are in no order.
[[nodiscard]] int bag_number(const std::filesystem::path& bag);

/// The folder below `runs` of a run that begins now: the time, without colons. No run's before: a computer
/// whose clock starts at the same time with each power-up gives the same time again.
[[nodiscard]] std::filesystem::path new_run(const std::filesystem::path& runs);

/// Removes the oldest bags beyond the limits; the two newest of `run` stay. Where `run` lies in a folder
/// `runs`, all runs in it share the limits, and runs of which nothing is left go too. First the ordinary
/// bags, then those below stops/. `run` is the newest whatever the clock said of its files. Throws Error at
/// the end where one could not be removed.
void make_room(const std::filesystem::path& run, const RoomLimits& limits);

}  // namespace madori::app
