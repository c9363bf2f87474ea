#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "mapping/georeference/mosaic.hpp"
#include "mapping/georeference/tile_store.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {
namespace {

struct TilesArguments {
  std::string site;
  mapping::LatLon place;
  int zoom = 18;
  double radius_m = 200.0;
  std::string source = "seamlessphoto";
  std::string attribution;
  double timeout_s = 30.0;
  mapping::DownloadOptions download;
  std::string json_file;
};

void show_progress(std::size_t done, std::size_t all) {
  if (::isatty(STDERR_FILENO) != 0)
    std::fprintf(stderr, "\r\033[K%zu of %zu tiles%s", done, all, done == all ? "\r\033[K" : "");
}

void report(const TilesArguments& a, const mapping::DownloadReport& done, std::size_t all,
            const std::string& mosaic) {
  const double side = mapping::tile_side_m(a.place.latitude_deg, a.zoom);
  std::FILE* stream = a.json_file == "-" ? stderr : stdout;
  std::fprintf(stream, "tiles     %zu: %zu fetched, %zu were there, %zu do not exist\n", all, done.fetched,
               done.already_there, done.missing.size());
  std::fprintf(stream, "a tile    %.1f m, %.4f m/px at zoom %d\n", side, side / mapping::kTilePixels, a.zoom);
  std::fprintf(stream, "look at   %s\n", mosaic.c_str());
  write_json(a.json_file, {{"tiles", all},
                           {"fetched", done.fetched},
                           {"already_there", done.already_there},
                           {"missing", done.missing.size()},
                           {"tile_side_m", side},
                           {"m_per_px", side / mapping::kTilePixels},
                           {"mosaic", mosaic}});
}

void run(const TilesArguments& a) {
  expect_json(a.json_file, std::filesystem::path(a.site) / "tiles");
  (void)mapping::load_site(a.site);
  const mapping::TileSource source = mapping::find_tile_source(a.source, a.attribution);
  mapping::require_zoom(source, a.zoom);
  const auto tiles = mapping::tiles_around(a.place, a.radius_m, a.zoom);
  const mapping::TileStore store(std::filesystem::path(a.site) / "tiles", source);
  mapping::FetchOptions fetch;
  fetch.total_timeout = std::chrono::milliseconds(static_cast<long>(a.timeout_s * 1e3));
  fetch.connect_timeout = std::min(fetch.connect_timeout, fetch.total_timeout);
  const auto sleep = [](std::chrono::milliseconds time) { std::this_thread::sleep_for(time); };
  const auto done =
      mapping::download_tiles(store, tiles, mapping::http_fetcher(fetch), sleep, a.download, show_progress);
  const auto mosaic = store.folder() / ("mosaic-z" + std::to_string(a.zoom) + ".png");
  mapping::write_file_atomically(mosaic, mapping::mosaic_png(store, tiles));
  report(a, done, tiles.size(), mosaic.string());
}

}  // namespace

void add_tiles(CLI::App& app) {
  auto a = std::make_shared<TilesArguments>();
  CLI::App* command =
      app.add_subcommand("tiles", "save aerial photographs around a place; works offline afterwards");
  command->add_option("site", a->site, "the site folder")->required();
  command->add_option("--lat", a->place.latitude_deg, "latitude, degrees")->required();
  command->add_option("--lon", a->place.longitude_deg, "longitude, degrees")->required();
  command->add_option("--zoom", a->zoom, "zoom level")->required()->check(within(0, mapping::kMaxZoom));
  command->add_option("--radius-m", a->radius_m, "around the place, metres")
      ->capture_default_str()
      ->check(within(0.0, 1e6));
  command->add_option("--source", a->source, "seamlessphoto, ort, std, pale, or a URL with {z} {x} {y}")
      ->capture_default_str();
  command->add_option("--attribution", a->attribution, "whom to name on pictures, for a URL");
  command->add_option("--timeout", a->timeout_s, "seconds a request may take")
      ->capture_default_str()
      ->check(within(0.05, 600.0));
  command->add_option("--attempts", a->download.attempts, "attempts a tile")
      ->capture_default_str()
      ->check(within(1, 20));
  command->add_option("--json", a->json_file, "write the figures to a file; - for stdout");
  command->callback([a] { run(*a); });
}

}  // namespace madori::app
