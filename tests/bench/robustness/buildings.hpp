#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/robustness/drawn_buildings.hpp"

namespace madori::bench {

using Truth = std::vector<app::StampedPose>;

/// A log with its reference in the drawing's frame and its drawing, nothing harmed yet.
struct Building {
  std::string name;
  Records log;
  Truth truth;
  mapping::Walls walls;
  std::filesystem::path relations;
};

/// `folder` is DATA/lidar2d. A log without a drawing gets the walls that it shows itself (walls_from_log).
[[nodiscard]] Building with_own_drawing(const std::filesystem::path& folder, const std::string& name);
/// The Intel lab with its real layout, or another `picture` beside it, harmed.
[[nodiscard]] Building intel(const std::filesystem::path& folder, const std::string& picture = "layout.png",
                             const PictureHarm& harm = {});

}  // namespace madori::bench
