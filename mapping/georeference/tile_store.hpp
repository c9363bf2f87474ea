#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mapping/georeference/tile_fetch.hpp"
#include "mapping/georeference/tile_math.hpp"
#include "mapping/georeference/tile_source.hpp"

namespace madori::mapping {

/// The tiles that a circle touches, row by row from the north-west. Across the date line they go on in the
/// west. Throws Error beyond 2,500 tiles.
[[nodiscard]] std::vector<TileId> tiles_around(const LatLon& place, double radius_m, int zoom);

/// The folder `tiles` of a site: {z}/{x}/{y}.jpg or .png, source.json and attribution.txt. One source a
/// folder.
class TileStore {
 public:
  /// Creates the folder and removes what a killed download left behind. Throws Error when another download
  /// runs or the folder holds another source's tiles.
  TileStore(std::filesystem::path folder, TileSource source);
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  [[nodiscard]] const TileSource& source() const { return source_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path file_of(const TileId& tile) const;
  /// There, and a whole picture.
  [[nodiscard]] bool holds(const TileId& tile) const;
  /// Atomic: the whole tile or nothing.
  void save(const TileId& tile, const std::string& bytes) const;

 private:
  void describe() const;

  std::filesystem::path folder_;
  TileSource source_;
  int lock_ = -1;
};

struct DownloadOptions {
  int attempts = 4;                              ///< a tile
  std::chrono::milliseconds first_wait{500};     ///< before the second attempt; doubles each time
  std::chrono::milliseconds between_tiles{100};  ///< politeness
};

struct DownloadReport {
  std::size_t fetched = 0;
  std::size_t already_there = 0;
  std::vector<TileId> missing;  ///< the source has no tile there
};

using Sleep = std::function<void(std::chrono::milliseconds)>;
using TileProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Fetches what the store does not hold yet; the next call goes on where this one ended. Throws Error when
/// the source cannot be used (after the last attempt), what was fetched until then stays; and where it has
/// none of these tiles.
DownloadReport download_tiles(const TileStore& store, const std::vector<TileId>& tiles,
                              const FetchTile& fetch, const Sleep& sleep, const DownloadOptions& options = {},
                              const TileProgress& progress = {});

}  // namespace madori::mapping
