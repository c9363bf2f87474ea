#include "app/grid_map_file.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <sstream>
#include <utility>

#include "core/result.hpp"
#include "core/transform2.hpp"
#include "mapping/picture/load_image.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::app {
namespace {

GridMap read_yaml(const std::filesystem::path& file, std::string& image) {
  try {
    const YAML::Node node = YAML::LoadFile(file.string());
    GridMap map;
    image = node["image"].as<std::string>();
    map.cell_m = node["resolution"].as<double>();
    const auto origin = node["origin"].as<std::vector<double>>();
    if (origin.size() > 1) map.origin = {origin[0], origin[1]};
    if (origin.size() > 2) map.yaw_rad = origin[2];
    map.occupied_over = node["occupied_thresh"].as<double>(map.occupied_over);
    map.negate = node["negate"].as<int>(0) != 0;
    return map;
  } catch (const YAML::Exception& e) {
    throw Error(file.string(), std::string("is no map_server file: ") + e.what(), "");
  }
}

/// An 8-bit PGM (P5). Throws Error.
mapping::GrayImage read_pgm(const std::filesystem::path& file) {
  const std::string bytes = mapping::file_content(file);
  std::istringstream in(bytes);
  std::string magic;
  in >> magic >> std::ws;
  while (in.peek() == '#') {
    std::string comment;
    std::getline(in, comment);
    in >> std::ws;
  }
  mapping::GrayImage image;
  int most = 0;
  in >> image.width_px >> image.height_px >> most;
  const auto begin = static_cast<std::size_t>(in.tellg()) + 1;
  const bool sane = in && magic == "P5" && most == 255 && image.width_px > 0 && image.height_px > 0;
  const std::size_t size = sane ? static_cast<std::size_t>(image.width_px) * image.height_px : 0;
  if (!sane || begin > bytes.size() || bytes.size() - begin < size)
    throw Error(file.string(), "is no 8-bit PGM, or is cut off", "the picture that the map names");
  image.pixels.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                      bytes.begin() + static_cast<std::ptrdiff_t>(begin + size));
  return image;
}

}  // namespace

GridMap load_grid_map(const std::filesystem::path& yaml) {
  std::string image;
  GridMap map = read_yaml(yaml, image);
  const auto picture =
      std::filesystem::path(image).is_absolute() ? std::filesystem::path(image) : yaml.parent_path() / image;
  mapping::GrayImage grey = picture.extension() == ".pgm" ? read_pgm(picture) : mapping::load_image(picture);
  if (!(map.cell_m > 0.0 && std::isfinite(map.cell_m)))
    throw Error(yaml.string(), "has no resolution above zero", "metres a pixel");
  map.width = grey.width_px;
  map.height = grey.height_px;
  map.pixels = std::move(grey.pixels);
  return map;
}

void save_grid_map(const std::filesystem::path& stem, const GridMap& map) {
  std::string pgm = "P5\n" + std::to_string(map.width) + ' ' + std::to_string(map.height) + "\n255\n";
  pgm.append(map.pixels.begin(), map.pixels.end());
  std::ostringstream yaml;
  yaml.precision(12);
  // map_server calls free what is below free_thresh: unknown, 50 / 255 = 0.19608, must not be.
  yaml << "image: " << stem.filename().string() << ".pgm\nmode: trinary\nresolution: " << map.cell_m
       << "\norigin: [" << map.origin.x_m << ", " << map.origin.y_m << ", " << map.yaw_rad
       << "]\nnegate: " << (map.negate ? 1 : 0) << "\noccupied_thresh: " << map.occupied_over
       << "\nfree_thresh: 0.196\n";
  mapping::write_file_atomically(stem.string() + ".pgm", pgm);
  mapping::write_file_atomically(stem.string() + ".yaml", yaml.str());
}

std::vector<Point2<Map>> occupied_cells(const GridMap& map) {
  const Transform2<Map, Map> frame(map.origin.x_m, map.origin.y_m, map.yaw_rad);
  std::vector<Point2<Map>> places;
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const int value = map.pixels[static_cast<std::size_t>(row) * map.width + column];
      const double dark = (map.negate ? value : 255 - value) / 255.0;
      if (dark <= map.occupied_over) continue;
      places.push_back(frame *
                       Point2<Map>{(column + 0.5) * map.cell_m, (map.height - row - 0.5) * map.cell_m});
    }
  return places;
}

}  // namespace madori::app
