#pragma once

#include <filesystem>
#include <string>

#include "localization/warp/warp_fit.hpp"

namespace madori::localization {

/// The text of a site's learned/warp.txt: `madori-warp 1`, the fingerprint of the walls, the warp and what
/// was seen of each wall.
[[nodiscard]] std::string warp_text(const WarpFit& fit, const mapping::Walls& drawn);

/// Takes what was learned before into `fit`. Nothing is taken where the file belongs to other walls or is
/// damaged: then the answer says so in an operator's words. Empty where all is well, and where there is no
/// file.
[[nodiscard]] std::string load_warp(const std::filesystem::path& file, const mapping::Walls& drawn,
                                    WarpFit& fit);
/// Writes the file atomically, and its folder where there is none. Throws Error (disk full, no permission).
void save_warp(const std::filesystem::path& file, const WarpFit& fit, const mapping::Walls& drawn);

}  // namespace madori::localization
