#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace madori::bench {

/// One start in one building that is not as drawn: a row of the folder's README and a scenario beside it.
struct BuildingStart {
  std::string name;              ///< "hotel_L1/start0"
  std::filesystem::path folder;  ///< routes/, true.csv, startN.yaml
  std::filesystem::path scenario;
  std::filesystem::path drawing;
  double m_per_px = 0.0;

  [[nodiscard]] std::string building() const { return folder.filename().string(); }
};

/// Every start below `buildings` whose name contains one of `only` (comma between; empty: all). Drawings and
/// scales are those of the table in `buildings`/README.md, drawings relative to the folder above it. Throws
/// Error where the table, a drawing or a start is missing.
[[nodiscard]] std::vector<BuildingStart> list_starts(const std::filesystem::path& buildings,
                                                     const std::string& only);

/// What `madori import DRAWING --scale` makes in the empty folder `site`, with the reference vehicle, a
/// VLP-16, and the building's routes, true walls and start.
void make_site(const BuildingStart& start, const std::filesystem::path& site);

/// The walls in `file` (u1,v1,u2,v2: pixels of the drawing, v down) take the place of the imported ones.
/// Throws Error where the file is missing or broken.
void use_hand_made_walls(const BuildingStart& start, const std::filesystem::path& file,
                         const std::filesystem::path& site);

}  // namespace madori::bench
