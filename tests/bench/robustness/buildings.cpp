#include "tests/bench/robustness/buildings.hpp"

#include "app/trajectory_score.hpp"

namespace madori::bench {

Building with_own_drawing(const std::filesystem::path& folder, const std::string& name) {
  Building b{name,
             load_records(folder / name / (name + ".log")),
             app::load_tum(folder / name / "reference.tum"),
             {},
             folder / name / (name + ".relations")};
  b.walls = walls_from_log(b.log, b.truth);
  return b;
}

Building intel(const std::filesystem::path& folder, const std::string& picture, const PictureHarm& harm) {
  const auto at = folder / "intel";
  Building b{"intel", load_records(at / "intel.log"), app::load_tum(at / "reference.tum"),
             picture_walls(at / picture, 0.04259, harm), at / "intel.relations"};
  const Transform2<Map, Map> moved = app::load_map_from_reference(at / "layout.yaml");
  for (app::StampedPose& pose : b.truth) pose.map_from_base = moved * pose.map_from_base;
  return b;
}

}  // namespace madori::bench
