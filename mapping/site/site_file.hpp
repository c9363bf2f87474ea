#pragma once

#include <filesystem>

#include "mapping/site/site.hpp"

namespace madori::mapping {

/// As load_site, of a file that need not lie in a site folder: one that is about to become a site.yaml.
[[nodiscard]] Site read_site_file(const std::filesystem::path& file);

}  // namespace madori::mapping
