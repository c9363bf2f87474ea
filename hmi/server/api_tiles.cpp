#include <algorithm>
#include <fstream>
#include <iterator>
#include <thread>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "mapping/georeference/tile_store.hpp"
#include "mapping/picture/image_header.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// 256, or 512 of a source with larger tiles: the width in the picture's header.
int picture_side(const fs::path& file) {
  const std::string bytes = mapping::file_content(file);
  const auto header =
      mapping::read_image_header({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return header && header->width_px > 0 ? static_cast<int>(header->width_px) : mapping::kTilePixels;
}

/// The place in the middle of the tiles.
void add_middle(json& wire) {
  if (wire["tiles"].empty()) return;
  mapping::TilePoint middle;
  for (const auto& tile : wire["tiles"]) {
    middle.x += tile[0].get<double>() + 0.5;
    middle.y += tile[1].get<double>() + 0.5;
  }
  const auto count = static_cast<double>(wire["tiles"].size());
  const mapping::LatLon place =
      mapping::place_of({middle.x / count, middle.y / count}, wire["zoom"].get<int>());
  wire["latitude_deg"] = place.latitude_deg;
  wire["longitude_deg"] = place.longitude_deg;
}

/// The tiles on the disk and whom to name for them.
json saved_tiles(const fs::path& folder) {
  json wire{{"source", ""},
            {"attribution", ""},
            {"zoom", 0},
            {"tile_px", mapping::kTilePixels},
            {"latitude_deg", nullptr},
            {"longitude_deg", nullptr},
            {"tiles", json::array()}};
  std::ifstream stream(folder / "source.json");
  const json source = json::parse(stream, nullptr, false);
  if (!source.is_object()) return wire;
  wire["source"] = source.value("name", "");
  wire["attribution"] = source.value("attribution", "");
  std::error_code missing;
  for (const auto& file : fs::recursive_directory_iterator(folder, missing)) {
    const std::string extension = file.path().extension().string();
    if (extension != ".jpg" && extension != ".png") continue;
    const auto column = file.path().parent_path();
    const int zoom = std::atoi(column.parent_path().filename().c_str());
    if (zoom < wire["zoom"].get<int>()) continue;
    if (zoom > wire["zoom"].get<int>()) wire["tiles"].clear();
    wire["zoom"] = zoom;
    if (wire["tiles"].empty()) wire["tile_px"] = picture_side(file.path());
    wire["tiles"].push_back({std::atoi(column.filename().c_str()), std::atoi(file.path().stem().c_str())});
  }
  add_middle(wire);
  return wire;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

Response tile(const fs::path& folder, const Request& request) {
  if (!std::ranges::all_of(request.captures, is_number))
    return Response::error(404, "not-found", "there is no such tile");
  const fs::path file = folder / request.captures[0] / request.captures[1] / request.captures[2];
  for (const auto& [extension, type] : {std::pair(".jpg", "image/jpeg"), std::pair(".png", "image/png")}) {
    std::ifstream stream(file.string() + extension, std::ios::binary);
    if (!stream) continue;
    Response response{200, type, {std::istreambuf_iterator<char>(stream), {}}, {}, {}};
    response.headers["Cache-Control"] = "private, max-age=86400";
    return response;
  }
  return Response::error(404, "not-found", "this tile was not saved");
}

json sources() {
  json list = json::array();
  for (const auto& s : mapping::known_tile_sources())
    list.push_back({{"name", s.name},
                    {"min_zoom", s.min_zoom},
                    {"max_zoom", s.max_zoom},
                    {"attribution", s.attribution}});
  return list;
}

Response fetch_tiles(ApiContext& context, const json& wanted) {
  const int zoom = whole_number<int>(wanted.at("zoom"));
  const mapping::LatLon place{wanted.at("latitude_deg").get<double>(),
                              wanted.at("longitude_deg").get<double>()};
  const auto tiles = mapping::tiles_around(place, wanted.at("radius_m").get<double>(), zoom);
  const auto name = wanted.at("source").get<std::string>();
  if (name.starts_with("file"))
    throw Error(name, "is no source for the panel", "use http or https, or fetch them with madori tiles");
  const mapping::TileSource source = mapping::find_tile_source(name, wanted.value("attribution", ""));
  mapping::require_zoom(source, zoom);
  const fs::path folder = context.editor.folder() / "tiles";
  const bool started = context.job.start("tiles", [folder, source, tiles](const Job::Progress& progress) {
    const mapping::TileStore store(folder, source);
    const auto report = mapping::download_tiles(
        store, tiles, mapping::http_fetcher(), [](auto pause) { std::this_thread::sleep_for(pause); }, {},
        [&](std::size_t done, std::size_t all) {
          progress(source.name,
                   static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(all, 1)));
        });
    return Job::Outcome{std::to_string(report.fetched) + " tiles", nullptr};
  });
  if (!started) return Response::error(409, "busy", "the server is busy with other work");
  return answer(context.job.state());
}

}  // namespace

void add_tile_routes(Router& router, ApiContext& context) {
  const fs::path tiles = context.editor.folder() / "tiles";
  router.add("GET", "/api/site/tiles", Role::Viewer,
             answering([tiles](const Request&) { return saved_tiles(tiles); }), Work::Worker);
  router.add("GET", "/api/site/tiles/sources", Role::Viewer,
             answering([](const Request&) { return sources(); }));
  router.add("POST", "/api/site/tiles", Role::Integrator,
             guarded([&context](const Request& r) { return fetch_tiles(context, body_of(r)); }),
             Work::Worker);
  router.add(
      "GET", "/api/site/tiles/*/*/*", Role::Viewer, [tiles](const Request& r) { return tile(tiles, r); },
      Work::Worker);
}

}  // namespace madori::hmi
