#include "core/result.hpp"
#include "mapping/georeference/tile_store.hpp"

namespace madori::mapping {
namespace {

using Outcome = FetchedTile::Outcome;

FetchedTile fetch_with_patience(const std::string& url, const FetchTile& fetch, const Sleep& sleep,
                                const DownloadOptions& options) {
  FetchedTile answer = fetch(url);
  auto wait = options.first_wait;
  for (int attempt = 1; answer.outcome == Outcome::TryAgain && attempt < options.attempts; ++attempt) {
    sleep(wait);
    wait *= 2;
    answer = fetch(url);
  }
  return answer;
}

}  // namespace

DownloadReport download_tiles(const TileStore& store, const std::vector<TileId>& tiles,
                              const FetchTile& fetch, const Sleep& sleep, const DownloadOptions& options,
                              const TileProgress& progress) {
  DownloadReport report;
  std::size_t done = 0;
  bool asked = false;
  for (const TileId& tile : tiles) {
    if (store.holds(tile)) {
      ++report.already_there;
    } else {
      if (asked) sleep(options.between_tiles);
      asked = true;
      const std::string url = store.source().url_of(tile);
      FetchedTile answer = fetch_with_patience(url, fetch, sleep, options);
      if (answer.outcome == Outcome::NotThere) {
        report.missing.push_back(tile);
      } else if (answer.outcome != Outcome::Ok) {
        throw Error(url, answer.reason,
                    std::to_string(done) + " of " + std::to_string(tiles.size()) +
                        " tiles are done and stay; check the source and run the command again to go on");
      } else {
        store.save(tile, answer.body);
        ++report.fetched;
      }
    }
    ++done;
    if (progress) progress(done, tiles.size());
  }
  if (!tiles.empty() && report.missing.size() == tiles.size())
    throw Error(store.source().name, "has no tile there at zoom " + std::to_string(tiles.front().zoom),
                "check the place, or use a smaller zoom");
  return report;
}

}  // namespace madori::mapping
