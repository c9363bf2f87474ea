#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/pose_estimate.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"

namespace madori::app {

/// A pose of a trajectory file.
struct StampedPose {
  Stamp stamp{};
  Transform2<Map, Base> map_from_base;
};

/// The first line of a TUM file.
inline constexpr const char* kTumHead = "# timestamp x y z qx qy qz qw, Map frame\n";
/// A line of a TUM file, `timestamp x y z qx qy qz qw`, seconds and metres, with its line end.
[[nodiscard]] std::string tum_line(Stamp stamp, const Transform2<Map, Base>& map_from_base);
/// Reads a TUM file; `#` starts a comment. In the order of the file. Throws Error with file and line on
/// anything that is not eight finite numbers with a quaternion of unit length, or when there is no pose.
[[nodiscard]] std::vector<StampedPose> load_tum(const std::filesystem::path& file);

}  // namespace madori::app
