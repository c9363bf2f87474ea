#include "app/learned/earlier_walls.hpp"

#include <algorithm>
#include <exception>

#include "mapping/days/map_frame.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/site/site_versions.hpp"
#include "mapping/wall_map/wall.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {

namespace fs = std::filesystem;

bool are_earlier_walls(const fs::path& site, std::uint64_t checksum) try {
  const auto versions = mapping::site_versions(site);
  if (versions.empty()) return false;
  const fs::path objects = site / "versions/objects";
  const std::string frame = mapping::map_frame(site, mapping::load_site(site));
  return std::any_of(versions.rbegin(), versions.rend(), [&](const mapping::SiteVersion& version) {
    const auto walls = version.files.find("walls.csv"), record = version.files.find("site.yaml");
    return walls != version.files.end() && record != version.files.end() &&
           mapping::walls_checksum(mapping::load_walls(objects / walls->second)) == checksum &&
           mapping::map_frame(site, mapping::read_site_file(objects / record->second)) == frame;
  });
} catch (const std::exception&) {
  return false;
}

}  // namespace madori::app
