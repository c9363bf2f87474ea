#pragma once

#include <filesystem>
#include <string>

#include "localization/wall_reliability/wall_reliability.hpp"

namespace madori::localization {

/// The text of reliability.csv: `wall_id,piece,x1,y1,x2,y2,in_place,beside,missed,offset_m,offset_sigma_m,
/// drawn_offset_m,state`, a line a piece.
[[nodiscard]] std::string reliability_csv(const WallReliability& reliability);

/// Takes what was learned before into `reliability`, of the pieces that lie where they lay: a wall that was
/// erased or drawn elsewhere takes what was learned of it with it. Nothing is taken where the file belongs to
/// other walls altogether (the drawing was scaled or imported anew since) or is damaged: then the answer says
/// so in an operator's words. Empty where all is well, and where there is no file.
[[nodiscard]] std::string load_reliability(const std::filesystem::path& file, WallReliability& reliability);
/// Writes the file atomically. Throws Error (disk full, no permission).
void save_reliability(const std::filesystem::path& file, const WallReliability& reliability);

}  // namespace madori::localization
