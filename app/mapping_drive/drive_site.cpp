#include "app/mapping_drive/drive_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "app/lidars.hpp"
#include "app/mapped_site.hpp"
#include "localization/drawing_fit/standing.hpp"
#include "localization/drawing_fit/wall_lines.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = "a drive by hand";
constexpr double kLeastDrivenM = 2.0;
constexpr std::size_t kLeastKeyframes = 3;

fs::path setup_file(const fs::path& site) {
  return site / "mapping" / "setup.yaml";
}

/// Whether the drawing is still the map that was driven: not another one, not rescaled.
bool is_as_mapped(const fs::path& site) {
  try {
    const auto scale = mapping::load_site(site).scale;
    return scale && scale->method == "mapped";
  } catch (const std::exception&) {  // told by who loads the site to drive
    return false;
  }
}

std::string way_csv(const std::vector<planning::DrivenPose>& way) {
  std::string text = "time_s,x_m,y_m,yaw_rad\n";
  for (const auto& [stamp, pose] : way)
    text += fmt::format("{:.3f},{:.4f},{:.4f},{:.5f}\n", to_seconds(stamp), pose.x_m(), pose.y_m(),
                        pose.yaw_rad());
  return text;
}

std::vector<planning::DrivenPose> way_of(const localization::FinishedMap& map,
                                         const Transform2<Map, Map>& map_from_memory) {
  std::vector<planning::DrivenPose> way;
  for (const auto& scan : map.scans)
    planning::note_way(way, scan.stamp, map_from_memory * scan.map_from_base);
  return way;
}

/// The last look moves the end of the drive; what the wheels did since its last scan stays. Nothing where
/// that scan lies nowhere in the map: the place is then found as after any other start.
std::optional<StoredPose> last_pose(const localization::FinishedMap& map, const MappedPose& newest,
                                    const StandsAt& stands, const MappedSite& mapped) {
  const auto scan = std::ranges::find(map.scans, newest.pose.stamp, &localization::MomentPose::stamp);
  if (scan == map.scans.end()) return std::nullopt;
  const auto since = newest.pose.map_from_base.inverse() * stands.map_from_base;
  StoredPose pose;
  pose.stamp = newest.pose.stamp;
  pose.map_from_base = mapped.map_from_memory * scan->map_from_base * since;
  pose.covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  pose.wheels = stands.wheels;
  pose.walls = mapping::walls_fingerprint(mapped.walls);
  return pose;
}

}  // namespace

fs::path drive_file(const fs::path& site) {
  return site / "mapping" / "drive.bin";
}

bool has_open_drive(const fs::path& site) {
  std::error_code missing;
  return fs::exists(drive_file(site), missing) && fs::exists(setup_file(site), missing) &&
         !fs::exists(site / "site.yaml", missing);
}

mapping::Site load_mapping_setup(const fs::path& site) {
  mapping::Site setup = mapping::read_site_file(setup_file(site));
  (void)lidars_of(setup, setup_file(site).parent_path());
  return setup;
}

void save_mapping_setup(const fs::path& site, const MappingSetup& setup) {
  mapping::Site record;
  record.name = site.filename().string();
  record.drawing = {"none", 1, 1, 1, 0.0};
  record.vehicle = setup.vehicle;
  record.sensors = setup.sensors;
  (void)lidars_of(record, setup_file(site).parent_path());
  fs::create_directories(site / "mapping");
  const fs::path tried = site / "mapping" / "setup.tried.yaml";
  mapping::write_new_file(tried, mapping::site_yaml(record));
  try {
    (void)mapping::read_site_file(tried);  // refuses values out of range, with the reason
  } catch (...) {
    fs::remove(tried);
    throw;
  }
  fs::remove(tried);
  mapping::write_file_atomically(setup_file(site), mapping::site_yaml(record));
}

std::size_t make_site_of_drive(MappingDesk& desk, const fs::path& site, const std::optional<StandsAt>& stands,
                               const std::function<void(const std::string&, double)>& progress) {
  const MappingProgress drive = desk.progress();
  if (drive.driven_m < kLeastDrivenM || drive.keyframes < kLeastKeyframes)
    throw NoMap("mapping-too-short",
                "too little was driven to make a map of it - drive at least 2 m, past every wall that "
                "counts, then finish");
  progress("last-look", 0.1);
  const localization::FinishedMap map = desk.finish();
  progress("walls", 0.7);
  const localization::MemoryCloud cloud = localization::standing_cloud(map.memory);
  if (localization::wall_lines(cloud).empty())
    throw NoMap("mapping-no-wall",
                "no straight wall was seen twice - drive slowly along the walls, then finish");
  const MappedSite mapped = map_site(cloud, kSource);
  const mapping::Site setup = load_mapping_setup(site);
  MappedFor whom{site.filename().string(), kSource, setup.vehicle, setup.sensors, {}};
  whom.files[kWayFile] = way_csv(way_of(map, mapped.map_from_memory));
  const auto newest = desk.newest();
  if (stands && newest)
    if (const auto pose = last_pose(map, *newest, *stands, mapped))
      whom.files[kPoseFile] = stored_pose_yaml(*pose);
  progress("save", 0.9);
  save_mapped_site(mapped, site, whom);
  return mapped.walls.size();
}

std::vector<planning::DrivenPose> load_driven_way(const fs::path& site) {
  if (!is_as_mapped(site)) return {};
  std::ifstream in(site / kWayFile);
  std::vector<planning::DrivenPose> way;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    double time_s = 0.0, x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &time_s, &x_m, &y_m, &yaw_rad) != 4) return {};
    const Transform2<Map, Base> pose(x_m, y_m, yaw_rad);
    if (!pose.is_finite() || !std::isfinite(time_s) || std::abs(time_s) > 1e11) return {};
    way.push_back({stamp_from_seconds(time_s), pose});
  }
  return way;
}

}  // namespace madori::app
