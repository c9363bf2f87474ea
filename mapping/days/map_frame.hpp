#pragma once

#include <filesystem>
#include <string>

#include "mapping/site/site.hpp"

namespace madori::mapping {

/// A name of a site's Map frame: another one where the drawing (name, size, pixel grid) or its scale is
/// another; the same when walls are edited. Sixteen hexadecimal digits.
[[nodiscard]] std::string map_frame(const std::filesystem::path& folder, const Site& site);

}  // namespace madori::mapping
