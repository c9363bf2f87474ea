#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/trajectory_file.hpp"

namespace madori::app {

/// A measured relation: the pose at `to` seen from the pose at `from` (Kümmerle et al. 2009, On Measuring the
/// Accuracy of SLAM Algorithms).
struct Relation {
  Stamp from{};
  Stamp to{};
  Transform2<Base, Base> motion;
};

/// `t1 t2 x y z roll pitch yaw` a line, seconds, metres, radians. Throws Error with file and line.
[[nodiscard]] std::vector<Relation> load_relations(const std::filesystem::path& file);
/// The transform of a layout file (`map_from_reference: {x_m, y_m, yaw_deg}`). Throws Error.
[[nodiscard]] Transform2<Map, Map> load_map_from_reference(const std::filesystem::path& file);

/// Errors in position and heading at the stamps of `truth`. Throws Error when no stamp finds an estimate.
[[nodiscard]] nlohmann::json score_against_truth(std::vector<StampedPose> estimate,
                                                 std::vector<StampedPose> truth);
/// Errors of the motions between the stamps of the relations. Throws Error when none can be scored.
[[nodiscard]] nlohmann::json score_against_relations(std::vector<StampedPose> estimate,
                                                     const std::vector<Relation>& relations);
/// Either result in words.
[[nodiscard]] std::string score_text(const nlohmann::json& score);

}  // namespace madori::app
