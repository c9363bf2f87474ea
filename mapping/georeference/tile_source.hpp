#pragma once

#include <string>
#include <vector>

namespace madori::mapping {

/// A tile: zoom, column to the east, row to the south.
struct TileId {
  int zoom = 0;
  int x = 0;
  int y = 0;

  friend auto operator<=>(const TileId&, const TileId&) = default;
};

/// Where tiles come from, and whom to name wherever they are shown.
struct TileSource {
  std::string name;
  std::string url;  ///< with {z}, {x}, {y}; http, https or file
  int min_zoom = 0;
  int max_zoom = 30;
  std::string attribution;
  std::string extension;  ///< of the files, "jpg" or "png"

  [[nodiscard]] std::string url_of(const TileId& tile) const;
};

/// Throws Error where the source has no such tiles.
void require_zoom(const TileSource& source, int zoom);

/// The Geospatial Information Authority of Japan's layers (maps.gsi.go.jp/development/ichiran.html).
[[nodiscard]] const std::vector<TileSource>& known_tile_sources();

/// A known source by its name, or a URL template. Throws Error on neither, and on templates without {z}, {x},
/// {y}.
[[nodiscard]] TileSource find_tile_source(const std::string& name_or_template,
                                          const std::string& attribution = "");

}  // namespace madori::mapping
