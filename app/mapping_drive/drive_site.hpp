#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/mapping_drive/mapping_desk.hpp"
#include "app/pose/pose_store.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_versions.hpp"
#include "planning/route_graph/taught_route.hpp"

namespace madori::app {

/// What a drive without a drawing needs to know beforehand.
struct MappingSetup {
  mapping::VehicleRecord vehicle;
  std::vector<mapping::SensorRecord> sensors;
};

using mapping::kWayFile;

/// Files of a map by driving, in a folder that is no site yet.
[[nodiscard]] std::filesystem::path drive_file(const std::filesystem::path& site);
/// Whether a drive lies there of which no site was made yet.
[[nodiscard]] bool has_open_drive(const std::filesystem::path& site);
/// `site`/mapping/setup.yaml. Throws Error: no such file, a value out of range, a lidar mounted outside the
/// vehicle.
[[nodiscard]] mapping::Site load_mapping_setup(const std::filesystem::path& site);
/// Throws Error likewise; nothing is written then.
void save_mapping_setup(const std::filesystem::path& site, const MappingSetup& setup);

/// A drive that makes no map: `code` of the panel's catalogues, the sentence in English with its remedy.
struct NoMap : std::runtime_error {
  NoMap(std::string code_, const std::string& sentence)
      : std::runtime_error(sentence), code(std::move(code_)) {}
  std::string code;
};

/// Where the vehicle stands when a drive is finished.
struct StandsAt {
  Transform2<Map, Base> map_from_base;  ///< as the desk's newest pose, carried on by the wheels
  WheelCounters wheels;
};

/// Looks at all of the drive once more and makes the site of it: walls, picture, site.yaml with vehicle and
/// lidars, the way driven, the last pose; in one atomic step. Returns the number of walls. Throws NoMap,
/// Error.
std::size_t make_site_of_drive(MappingDesk& desk, const std::filesystem::path& site,
                               const std::optional<StandsAt>& stands,
                               const std::function<void(const std::string& stage, double share)>& progress);

/// The way that was driven when the site was mapped; empty where there is none, it cannot be read, or the
/// site has another drawing or scale by now.
[[nodiscard]] std::vector<planning::DrivenPose> load_driven_way(const std::filesystem::path& site);

}  // namespace madori::app
