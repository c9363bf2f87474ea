#pragma once

#include <cstdint>
#include <filesystem>

namespace madori::app {

/// Whether walls of this checksum (mapping::walls_checksum) are those of an earlier save of the site in the
/// Map frame that it has now: then walls were edited since, and nothing that was seen has moved. Reads the
/// site's versions; what cannot be read of them counts as no.
[[nodiscard]] bool are_earlier_walls(const std::filesystem::path& site, std::uint64_t checksum);

}  // namespace madori::app
