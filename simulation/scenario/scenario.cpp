#include "simulation/scenario/scenario.hpp"

#include "simulation/scenario/reading.hpp"

namespace madori::simulation {

using mapping::StrictYaml;

namespace {

constexpr int kFormat = 1;

template <class Item>
std::vector<Item> read_list(StrictYaml& yaml, const std::string& key, Item (*read)(StrictYaml&)) {
  std::vector<Item> items;
  for (StrictYaml& item : yaml.list(key)) items.push_back(read(item));
  return items;
}

template <class Section>
void read_section(StrictYaml& yaml, const std::string& key, Section& into, Section (*read)(StrictYaml)) {
  if (yaml.has(key)) into = read(yaml.section(key));
}

}  // namespace

const char* to_string(Device device) {
  switch (device) {
    case Device::Vlp16:
      return "vlp16";
    case Device::Lms1xx:
      return "lms1xx";
    case Device::S300:
      return "s300";
    case Device::Drive:
      return "drive";
  }
  return "";
}

PlanFrames Scenario::frames() const {
  return {1.0 + building.scale_error_x_percent / 100.0, 1.0 + building.scale_error_y_percent / 100.0,
          map_from_plan};
}

Scenario load_scenario(const std::filesystem::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  yaml.integer("madori_scenario", kFormat, kFormat);
  Scenario s;
  s.name = yaml.text("name");
  s.seed = static_cast<std::uint64_t>(yaml.integer_or("seed", 1, 0, 2'000'000'000));
  s.duration_s = yaml.number_or("duration_s", s.duration_s, 0.0, 1e7);
  if (yaml.has("map_from_plan")) s.map_from_plan = read_pose<Map, Plan>(yaml.section("map_from_plan"));
  s.start = read_pose<Plan, Base>(yaml.section("start"));
  if (yaml.has("building")) s.building = read_building(yaml.section("building"), file.parent_path());
  s.solids = read_list(yaml, "solids", read_solid);
  s.offices = read_list(yaml, "offices", read_office);
  s.glass = read_list(yaml, "glass", read_glass);
  s.ramps = read_list(yaml, "ramps", read_ramp);
  read_section(yaml, "furniture", s.furniture, read_furniture);
  s.doors = read_list(yaml, "doors", read_door);
  s.movers = read_list(yaml, "movers", read_mover);
  read_section(yaml, "vehicle", s.vehicle, read_vehicle_spec);
  read_section(yaml, "vlp16", s.vlp16, read_vlp16);
  read_section(yaml, "lms1xx", s.lms1xx, read_lms1xx);
  read_section(yaml, "s300", s.s300, read_s300);
  s.faults = read_list(yaml, "faults", read_fault);
  yaml.refuse_unknown_keys();
  return s;
}

}  // namespace madori::simulation
