#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "mapping/site/site.hpp"

namespace madori::mapping {

/// The drawing of a site as PNG, for a map on a screen: at most `longest_px` on its longer side. Throws
/// Error.
[[nodiscard]] std::vector<std::uint8_t> drawing_picture(const std::filesystem::path& folder, const Site& site,
                                                        int longest_px);

}  // namespace madori::mapping
