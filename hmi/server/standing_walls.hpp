#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::hmi {

/// What a person has said is still there although the lidar looks through it, a line a stretch:
/// frame,x1,y1,x2,y2,date in metres of the Map frame that `frame` names (mapping/days/map_frame.hpp).
inline constexpr const char* kStandingFile = "learned/standing_walls.csv";

/// Those of one frame. Lines that cannot be read are left out.
[[nodiscard]] std::vector<Segment2<Map>> standing_walls(const std::filesystem::path& site,
                                                        const std::string& frame);
/// Adds stretches, atomically. `date`: for a person who reads the file. Throws Error (disk full, no
/// permission).
void add_standing_walls(const std::filesystem::path& site, const std::string& frame,
                        const std::vector<Segment2<Map>>& segments, const std::string& date);

}  // namespace madori::hmi
