#include "mapping/georeference/tile_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/result.hpp"
#include "mapping/georeference/tile_image.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kMostTiles = 2500.0;

void remove_leftovers(const fs::path& folder) {
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension().string().starts_with(".tmp")) leftovers.push_back(entry.path());
  for (const auto& file : leftovers) fs::remove(file);
}

/// In {z}/{x}.
bool holds_any(const fs::path& folder) {
  constexpr int kDepth = 2;
  for (auto at = fs::recursive_directory_iterator(folder); at != fs::recursive_directory_iterator(); ++at)
    if (at.depth() == kDepth && at->is_regular_file()) return true;
  return false;
}

/// Distance from `value` to the piece [low, low + 1].
double gap(double value, double low) {
  return std::max({low - value, value - low - 1.0, 0.0});
}

}  // namespace

std::vector<TileId> tiles_around(const LatLon& place, double radius_m, int zoom) {
  const TilePoint centre = tile_of(place, zoom);
  const double radius = radius_m / tile_side_m(place.latitude_deg, zoom);
  if (!(radius_m >= 0.0) || std::pow(2.0 * radius + 1.0, 2) > kMostTiles)
    throw Error("--radius-m", "gives more than 2,500 tiles at zoom " + std::to_string(zoom),
                "choose a smaller radius or a smaller zoom");
  const auto size = static_cast<int>(std::ldexp(1.0, zoom));
  std::vector<TileId> tiles;
  for (int y = static_cast<int>(std::floor(centre.y - radius)); y <= centre.y + radius; ++y)
    for (int x = static_cast<int>(std::floor(centre.x - radius)); x <= centre.x + radius; ++x) {
      const TileId tile{zoom, ((x % size) + size) % size, y};
      if (y < 0 || y >= size || std::hypot(gap(centre.x, x), gap(centre.y, y)) > radius) continue;
      if (std::find(tiles.begin(), tiles.end(), tile) == tiles.end()) tiles.push_back(tile);
    }
  return tiles;
}

TileStore::TileStore(fs::path folder, TileSource source)
    : folder_(std::move(folder)), source_(std::move(source)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  lock_ = ::open((folder_ / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0)
    throw Error(folder_.string(), std::string("cannot be written: ") + std::strerror(errno),
                "check its permissions");
  try {
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
      throw Error(folder_.string(), "another download writes here", "wait until it has ended");
    remove_leftovers(folder_);
    describe();
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

TileStore::~TileStore() {
  ::close(lock_);
}

void TileStore::describe() const {
  const fs::path file = folder_ / "source.json";
  if (fs::exists(file) && holds_any(folder_)) {  // a source that gave nothing makes room for another
    const json known = json::parse(file_content(file), nullptr, false);
    if (!known.is_object() || known.value("name", "") != source_.name)
      throw Error(folder_.string(), "holds tiles of another source",
                  "use that source, or move the folder away first");
    return;
  }
  write_file_atomically(folder_ / "attribution.txt", source_.attribution + "\n");
  const json text{{"name", source_.name}, {"url", source_.url}, {"attribution", source_.attribution}};
  write_file_atomically(file, text.dump(2) + "\n");
}

fs::path TileStore::file_of(const TileId& tile) const {
  return folder_ / std::to_string(tile.zoom) / std::to_string(tile.x) /
         (std::to_string(tile.y) + "." + source_.extension);
}

bool TileStore::holds(const TileId& tile) const {
  return fs::exists(file_of(tile)) && tile_image_fault(file_content(file_of(tile))).empty();
}

void TileStore::save(const TileId& tile, const std::string& bytes) const {
  std::error_code error;
  fs::create_directories(file_of(tile).parent_path(), error);
  write_file_atomically(file_of(tile), bytes);
}

}  // namespace madori::mapping
