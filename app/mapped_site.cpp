#include "app/mapped_site.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/iso_time.hpp"
#include "app/mapping_drive/drive_site.hpp"
#include "core/result.hpp"
#include "localization/drawing_fit/wall_lines.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/import_picture.hpp"
#include "mapping/wall_map/palette_png.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

constexpr double kMarginM = 1.0;
constexpr const char* kDrawing = "drawing.png";

/// The turn that lays the walls along the axes: walls vote by their length for a direction within a quarter
/// turn, neighbours included.
double turn_onto_axes(const mapping::Walls& walls) {
  constexpr int kBins = 180;
  constexpr double kBin = 0.5 * kPi / kBins;
  std::array<double, kBins> votes{};
  const auto direction = [](const mapping::Wall& wall) {
    const double a =
        std::atan2(wall.segment.b.y_m - wall.segment.a.y_m, wall.segment.b.x_m - wall.segment.a.x_m);
    return std::fmod(a + 2.0 * kPi, 0.5 * kPi);
  };
  for (const mapping::Wall& wall : walls) {
    const int bin = static_cast<int>(direction(wall) / kBin);
    for (int i = -2; i <= 2; ++i)
      votes[static_cast<std::size_t>((bin + i + kBins) % kBins)] += wall.segment.length_m();
  }
  const double best =
      (static_cast<double>(std::max_element(votes.begin(), votes.end()) - votes.begin()) + 0.5) * kBin;
  double sum = 0.0;
  double weight = 1e-9;
  for (const mapping::Wall& wall : walls) {  // the mean of those near it
    const double off = std::remainder(direction(wall) - best, 0.5 * kPi);
    if (std::abs(off) < 3.0 * kBin) {
      sum += wall.segment.length_m() * off;
      weight += wall.segment.length_m();
    }
  }
  return -std::remainder(best + sum / weight, 0.5 * kPi);
}

/// Ink where something was seen, as a drawing has it.
mapping::GrayImage picture_of(const MappedSite& mapped) {
  mapping::GrayImage image;
  image.width_px = mapped.width_px;
  image.height_px = mapped.height_px;
  image.pixels.assign(static_cast<std::size_t>(image.width_px) * image.height_px, 255);
  for (const localization::CloudSurface& p : mapped.cloud) {
    const double half = 0.5 * localization::kVoxelM;
    for (double t = -half; t <= half; t += 0.5 * MappedSite::kMetresPerPixel) {
      const int u = static_cast<int>((p.x_m - p.normal_y * t) / MappedSite::kMetresPerPixel);
      const int v =
          image.height_px - 1 - static_cast<int>((p.y_m + p.normal_x * t) / MappedSite::kMetresPerPixel);
      if (u < 0 || v < 0 || u >= image.width_px || v >= image.height_px) continue;
      image.pixels[static_cast<std::size_t>(v) * image.width_px + u] = 0;
    }
  }
  return image;
}

std::string as_text(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

std::string picture_png(const mapping::GrayImage& image) {
  constexpr std::array<mapping::PaletteColour, 2> kInkOnPaper{{{0, 0, 0}, {255, 255, 255}}};
  std::vector<std::uint8_t> indices(image.pixels);
  for (std::uint8_t& v : indices) v = v == 0 ? 0 : 1;
  return as_text(mapping::palette_png(image.width_px, image.height_px, indices, kInkOnPaper));
}

/// What stands in its folder keeps its vehicle, its lidars and who guards it.
mapping::Site site_of(const MappedSite& mapped, const fs::path& folder, const MappedFor& whom) {
  mapping::Site site;
  if (fs::exists(folder / "site.yaml")) {
    site = mapping::load_site(folder);
    site.georeference.reset();
  } else {
    site.vehicle = whom.vehicle;
    site.sensors = whom.sensors;
  }
  site.name = whom.name;
  site.drawing = {kDrawing, mapped.width_px, mapped.height_px, 1, 0.0};
  site.scale =
      mapping::ScaleRecord{MappedSite::kMetresPerPixel, "mapped", 0.0, 0.0, iso_time_utc(), {whom.source}};
  return site;
}

/// What lies on the map of before, whose frame is another: where routes led there may be anything here.
void remove_what_lay_there(mapping::SiteTransaction& change, const fs::path& folder, const MappedFor& whom) {
  if (!fs::exists(folder / "site.yaml")) return;
  if (const std::string old = mapping::load_site(folder).drawing.file; old != kDrawing) change.remove(old);
  for (const char* file : {mapping::kOtherLinesFile, "routes/tree.csv", "routes/path.csv", kWayFile})
    if (!whom.files.contains(file)) change.remove(file);
}

}  // namespace

MappedSite map_site(const localization::MemoryCloud& memory, const std::string& log) {
  MappedSite mapped;
  mapped.walls = localization::wall_lines(memory);
  if (mapped.walls.empty()) {
    throw Error(log, "shows no straight wall",
                "give a log whose vehicle drives past its walls and scans them");
  }
  const Transform2<Map, Map> turn(0.0, 0.0, turn_onto_axes(mapped.walls));
  Point2<Map> low{1e9, 1e9};
  Point2<Map> high{-1e9, -1e9};
  for (const mapping::Wall& wall : mapped.walls) {  // what was seen far away through a window is left out
    const Segment2<Map> s = turn * wall.segment;
    low = {std::min({low.x_m, s.a.x_m, s.b.x_m}), std::min({low.y_m, s.a.y_m, s.b.y_m})};
    high = {std::max({high.x_m, s.a.x_m, s.b.x_m}), std::max({high.y_m, s.a.y_m, s.b.y_m})};
  }
  mapped.map_from_memory = Transform2<Map, Map>(kMarginM - low.x_m, kMarginM - low.y_m, 0.0) * turn;
  mapped.width_px = static_cast<int>((high.x_m - low.x_m + 2.0 * kMarginM) / MappedSite::kMetresPerPixel);
  mapped.height_px = static_cast<int>((high.y_m - low.y_m + 2.0 * kMarginM) / MappedSite::kMetresPerPixel);
  mapped.cloud = localization::moved(memory, mapped.map_from_memory);
  for (mapping::Wall& wall : mapped.walls) wall.segment = mapped.map_from_memory * wall.segment;
  return mapped;
}

void save_mapped_site(const MappedSite& mapped, const std::filesystem::path& folder, const MappedFor& whom) {
  constexpr double kScale = MappedSite::kMetresPerPixel;
  mapping::SiteTransaction change(folder);
  remove_what_lay_there(change, folder, whom);
  const mapping::GrayImage picture = picture_of(mapped);
  std::vector<mapping::PixelSegment> lines;
  for (const mapping::Wall& wall : mapped.walls)
    lines.push_back(mapping::on_drawing(wall.segment, mapped.height_px, kScale));
  mapping::stage_wall_files(change, mapped.walls, mapped.width_px * kScale, mapped.height_px * kScale, {});
  change.write(kDrawing, picture_png(picture));
  change.write("import.png", as_text(mapping::import_picture(picture, lines, {}, kScale)));
  change.write("site.yaml", mapping::site_yaml(site_of(mapped, folder, whom)));
  for (const auto& [file, content] : whom.files) change.write(file, content);
  change.commit();
}

}  // namespace madori::app
