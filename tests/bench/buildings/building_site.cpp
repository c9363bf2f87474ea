#include "tests/bench/buildings/building_site.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "core/result.hpp"
#include "mapping/drawing/import_drawing.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::bench {
namespace {

namespace fs = std::filesystem;

struct Drawing {
  fs::path file;
  double m_per_px = 0.0;
};

/// "drawings/clinic" names a folder with the drawing of that name.
fs::path drawing_file(const fs::path& data, const std::string& text) {
  const fs::path path = data / text;
  return fs::is_directory(path) ? path / (path.filename().string() + ".png") : path;
}

/// Rows `| folder | drawing, 0.055683 m/px | truth |`.
std::map<std::string, Drawing> drawings_of(const fs::path& buildings) {
  static const std::regex row(R"(^\|\s*(\w+)\s*\|\s*([^,|]+),\s*([0-9.]+)\s*m/px\s*\|.*)");
  std::ifstream readme(buildings / "README.md");
  std::map<std::string, Drawing> found;
  std::smatch match;
  for (std::string line; std::getline(readme, line);)
    if (std::regex_match(line, match, row))
      found[match[1]] = {drawing_file(buildings.lexically_normal() / "..", match[2]), std::stod(match[3])};
  if (found.empty())
    throw Error((buildings / "README.md").string(), "no table of buildings", "give the folder of buildings");
  return found;
}

bool is_wanted(const std::string& name, const std::string& only) {
  std::istringstream parts(only);
  for (std::string part; std::getline(parts, part, ',');)
    if (name.find(part) != std::string::npos) return true;
  return only.empty();
}

}  // namespace

std::vector<BuildingStart> list_starts(const fs::path& buildings, const std::string& only) {
  std::vector<BuildingStart> starts;
  for (const auto& [name, drawing] : drawings_of(buildings)) {
    if (!fs::exists(drawing.file)) throw Error(drawing.file.string(), "not found", "see the README's table");
    for (const auto& entry : fs::directory_iterator(buildings / name)) {
      const fs::path& file = entry.path();
      const std::string start = name + "/" + file.stem().string();
      if (file.extension() != ".yaml" || !is_wanted(start, only)) continue;
      starts.push_back({start, buildings / name, file, drawing.file, drawing.m_per_px});
    }
  }
  std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  if (starts.empty()) throw Error(buildings.string(), "no start matches \"" + only + "\"", "");
  return starts;
}

void make_site(const BuildingStart& start, const fs::path& site) {
  mapping::ImportOptions options;
  options.drawing = start.drawing;
  options.site = site;
  options.m_per_px = start.m_per_px;
  options.date = "2026-01-01T00:00:00Z";
  mapping::Site record = mapping::import_drawing(options).site;
  record.sensors = {{"top", "vlp16", 0.3, 0.0, 1.2, 0.0, 0.0}};
  mapping::save_site(site, record);
  fs::copy(start.folder / "routes", site / "routes",
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  fs::copy(start.folder / "true.csv", site / "true.csv");
  fs::copy(start.scenario, site / "start.yaml");
}

void use_hand_made_walls(const BuildingStart& start, const fs::path& file, const fs::path& site) {
  std::ifstream lines(file);
  if (!lines) throw Error(file.string(), "not found", "only some drawings have walls that a person marked");
  const mapping::Site record = mapping::load_site(site);
  const double s = start.m_per_px;
  mapping::Walls walls;
  std::string line;
  std::getline(lines, line);  // u1,v1,u2,v2
  for (double u1 = 0, v1 = 0, u2 = 0, v2 = 0; std::getline(lines, line);) {
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &u1, &v1, &u2, &v2) != 4)
      throw Error(file.string(), "has a line that is no wall: " + line, "");
    const double height = record.drawing.height_px;
    walls.push_back(
        {static_cast<int>(walls.size()) + 1, {{u1 * s, (height - v1) * s}, {u2 * s, (height - v2) * s}}});
  }
  mapping::SiteTransaction change(site);
  mapping::stage_wall_files(change, walls, record.drawing.width_px * s, record.drawing.height_px * s, {});
  change.commit();
}

}  // namespace madori::bench
