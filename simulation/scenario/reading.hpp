#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mapping/site/strict_yaml.hpp"
#include "simulation/scenario/scenario.hpp"

/// The parts of a scenario file; load_scenario() puts them together.
namespace madori::simulation {

inline constexpr double kFarM = 1e5;

/// `[x, y]` of a key.
[[nodiscard]] Point2<Plan> read_point(mapping::StrictYaml& yaml, const std::string& key);
/// `[[x, y], ...]`, at least `least` points.
[[nodiscard]] std::vector<Point2<Plan>> read_points(mapping::StrictYaml& yaml, const std::string& key,
                                                    std::size_t least);
[[nodiscard]] Segment2<Plan> read_line(mapping::StrictYaml& yaml, const std::string& key);
[[nodiscard]] std::vector<int> read_ids(mapping::StrictYaml& yaml, const std::string& key);
/// `{x_m, y_m, yaw_deg}`.
template <class To, class From>
[[nodiscard]] Transform2<To, From> read_pose(mapping::StrictYaml yaml) {
  const double x = yaml.number("x_m", -kFarM, kFarM), y = yaml.number("y_m", -kFarM, kFarM);
  const double yaw = to_rad(yaml.number_or("yaw_deg", 0.0, -360.0, 360.0));
  yaml.refuse_unknown_keys();
  return {x, y, yaw};
}

/// The value that a word stands for; throws Error that lists the words.
template <class Value>
[[nodiscard]] Value read_word(mapping::StrictYaml& yaml, const std::string& key,
                              const std::vector<std::pair<const char*, Value>>& words) {
  const std::string word = yaml.text(key);
  std::string all;
  for (const auto& [name, value] : words) {
    if (word == name) return value;
    all += std::string(all.empty() ? "" : ", ") + name;
  }
  throw yaml.error(key, "\"" + word + "\" is not known here", "use one of: " + all);
}

[[nodiscard]] BuildingSpec read_building(mapping::StrictYaml yaml, const std::filesystem::path& folder);
[[nodiscard]] SolidSpec read_solid(mapping::StrictYaml& yaml);
[[nodiscard]] OfficeSpec read_office(mapping::StrictYaml& yaml);
[[nodiscard]] GlassSpec read_glass(mapping::StrictYaml& yaml);
[[nodiscard]] RampSpec read_ramp(mapping::StrictYaml& yaml);
[[nodiscard]] FurnitureSpec read_furniture(mapping::StrictYaml yaml);
[[nodiscard]] DoorSpec read_door(mapping::StrictYaml& yaml);
[[nodiscard]] MoverSpec read_mover(mapping::StrictYaml& yaml);
[[nodiscard]] VehicleSpec read_vehicle_spec(mapping::StrictYaml yaml);
[[nodiscard]] Vlp16Spec read_vlp16(mapping::StrictYaml yaml);
[[nodiscard]] Lms1xxSpec read_lms1xx(mapping::StrictYaml yaml);
[[nodiscard]] S300Spec read_s300(mapping::StrictYaml yaml);
[[nodiscard]] FaultSpec read_fault(mapping::StrictYaml& yaml);

}  // namespace madori::simulation
