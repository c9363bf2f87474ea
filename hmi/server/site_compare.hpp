#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace madori::hmi {

/// What the saves of a site are: number, date, author and sentence, oldest first.
[[nodiscard]] nlohmann::json versions_json(const std::filesystem::path& site);
/// What differs between two saves: drawing, walls gone and new, points and legs of the routes. Throws Error
/// where one of them is not there.
[[nodiscard]] nlohmann::json compare_versions(const std::filesystem::path& site, int before, int after);

}  // namespace madori::hmi
