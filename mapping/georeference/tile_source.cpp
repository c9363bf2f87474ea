#include "mapping/georeference/tile_source.hpp"

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr const char* kGsi = "国土地理院 (Geospatial Information Authority of Japan)";

TileSource gsi(const std::string& layer, int min_zoom, const std::string& extension) {
  return {layer,    "https://cyberjapandata.gsi.go.jp/xyz/" + layer + "/{z}/{x}/{y}." + extension,
          min_zoom, 18,
          kGsi,     extension};
}

void replace(std::string& text, const std::string& key, int value) {
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at))
    text.replace(at, key.size(), std::to_string(value));
}

}  // namespace

std::string TileSource::url_of(const TileId& tile) const {
  std::string text = url;
  replace(text, "{z}", tile.zoom);
  replace(text, "{x}", tile.x);
  replace(text, "{y}", tile.y);
  return text;
}

void require_zoom(const TileSource& source, int zoom) {
  if (zoom < source.min_zoom || zoom > source.max_zoom)
    throw Error("zoom " + std::to_string(zoom), source.name + " has no such tiles",
                "use " + std::to_string(source.min_zoom) + " to " + std::to_string(source.max_zoom));
}

const std::vector<TileSource>& known_tile_sources() {
  static const std::vector<TileSource> sources{gsi("seamlessphoto", 2, "jpg"), gsi("ort", 14, "jpg"),
                                               gsi("std", 5, "png"), gsi("pale", 5, "png")};
  return sources;
}

TileSource find_tile_source(const std::string& name, const std::string& attribution) {
  std::string names;
  for (const auto& source : known_tile_sources()) {
    if (source.name == name) return source;
    names += source.name + ", ";
  }
  const bool scheme =
      name.starts_with("http://") || name.starts_with("https://") || name.starts_with("file://");
  for (const char* key : {"{z}", "{x}", "{y}"})
    if (!scheme || name.find(key) == std::string::npos)
      throw Error("--source " + name, "is no known source and no URL template",
                  "use " + names + "or e.g. https://host/{z}/{x}/{y}.png");
  const std::string path = name.substr(0, name.find('?'));
  return {name,
          name,
          0,
          30,
          attribution.empty() ? "source: " + name : attribution,
          path.ends_with(".jpg") || path.ends_with(".jpeg") ? "jpg" : "png"};
}

}  // namespace madori::mapping
