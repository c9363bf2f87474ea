#include "mapping/georeference/tile_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/result.hpp"
#include "mapping/georeference/mosaic.hpp"
#include "mapping/georeference/tile_image.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tile_server.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using test::TileReply;
using ::testing::HasSubstr;

std::string picture(int side, const char* kind = ".png") {
  cv::Mat noise(side, side, CV_8UC3);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  std::vector<std::uint8_t> bytes;
  cv::imencode(kind, noise, bytes);
  return {bytes.begin(), bytes.end()};
}

const std::vector<TileId> kFour{{3, 1, 1}, {3, 2, 1}, {3, 1, 2}, {3, 2, 2}};

struct Outcome {
  DownloadReport report;
  std::string error;
  int requests = 0;
  std::vector<milliseconds> sleeps;
  std::size_t whole_tiles = 0;
};

/// Downloads four tiles from a server that answers like this; every saved file must be a whole tile.
Outcome download(const fs::path& folder, const test::TileServer::Answer& answer) {
  Outcome outcome;
  const test::TileServer server(answer);
  FetchOptions fetch;
  fetch.total_timeout = fetch.connect_timeout = milliseconds(250);
  fetch.max_bytes = 1U << 20U;
  const TileStore store(folder, {"test", server.url(), 0, 30, "the test", "png"});
  try {
    outcome.report = download_tiles(store, kFour, http_fetcher(fetch),
                                    [&](milliseconds time) { outcome.sleeps.push_back(time); });
  } catch (const Error& e) {
    outcome.error = e.what();
  }
  outcome.requests = server.requests();
  fs::create_directories(folder / "3");
  for (const auto& entry : fs::recursive_directory_iterator(folder / "3"))
    if (entry.is_regular_file()) {
      std::ifstream stream(entry.path(), std::ios::binary);
      EXPECT_EQ(tile_image_fault(std::string(std::istreambuf_iterator<char>(stream), {})), "")
          << entry.path();
      ++outcome.whole_tiles;
    }
  return outcome;
}

/// Three good tiles; the third request's answer is the bad one.
test::TileServer::Answer bad(const TileReply& reply) {
  return [reply](const std::string& path) {
    return path == "/3/1/2.png" ? reply : TileReply{.body = picture(256)};
  };
}

TEST(TileStore, FetchesOnceAndWorksOfflineAfterwards) {
  const test::TemporaryFolder folder;
  const Outcome first = download(folder.path(), [](const auto&) { return TileReply{.body = picture(256)}; });
  EXPECT_EQ(first.error, "");
  EXPECT_EQ(first.report.fetched, 4U);
  EXPECT_THAT(first.sleeps, testing::Each(milliseconds(100)));  // polite
  EXPECT_TRUE(fs::exists(folder.path() / "attribution.txt"));
  const Outcome second = download(folder.path(), [](const auto&) { return TileReply{.status = 500}; });
  EXPECT_EQ(second.error, "");
  EXPECT_EQ(second.requests, 0);
  EXPECT_EQ(second.report.already_there, 4U);
}

TEST(TileStore, AMonsterIsRefusedBeforeItIsDecoded) {
  std::string monster = picture(256);
  constexpr std::size_t kWidth = 16, kHeight = 20;  // in IHDR, big-endian
  for (const std::size_t at : {kWidth, kHeight}) monster.replace(at, 4, std::string("\0\0\x75\x30", 4));
  EXPECT_THAT(tile_image_fault(monster), HasSubstr("30000 x 30000 pixels"));
}

struct Misbehaviour {
  const char* name;
  TileReply reply;
  const char* message;
  int requests;  ///< two good ones before, and this many with retries
};

TEST(TileStore, EveryMisbehaviourEndsInAClearMessageAndWholeTiles) {
  const std::string good = picture(256);
  const std::vector<Misbehaviour> cases{
      {"500", {.status = 500}, "answered 500", 6},
      {"429", {.status = 429}, "answered 429", 6},
      {"403", {.status = 403}, "answered 403", 3},
      {"slow", {.body = good, .pause = milliseconds(400)}, "Timeout", 6},
      {"truncated", {.body = good.substr(0, 5000), .declared = good.size()}, "cut off", 6},
      {"truncated without a word", {.body = good.substr(0, 5000)}, "cut off", 6},
      {"html", {.type = "text/html", .body = "<html>not found</html>"}, "text/html, not a picture", 3},
      {"html as picture", {.body = "<html>not found</html>"}, "no JPEG or PNG", 3},
      {"wrong size", {.body = picture(300)}, "300 x 300 pixels", 3},
      {"too large", {.body = std::string(2U << 20U, 'x')}, "too large", 3},
      {"redirect loop", {.status = 302, .location = "/3/1/2.png"}, "in a circle", 6}};
  for (const auto& c : cases) {
    const test::TemporaryFolder folder;
    const Outcome o = download(folder.path(), bad(c.reply));
    EXPECT_THAT(o.error, HasSubstr(c.message)) << c.name;
    EXPECT_THAT(o.error, HasSubstr("2 of 4 tiles are done")) << c.name;
    EXPECT_EQ(o.requests, c.requests) << c.name;
    EXPECT_EQ(o.whole_tiles, 2U) << c.name;
    const Outcome again = download(folder.path(), [&](const auto&) { return TileReply{.body = good}; });
    EXPECT_EQ(again.error, "") << c.name;
    EXPECT_EQ(again.report.already_there, 2U) << c.name;
    EXPECT_EQ(again.report.fetched, 2U) << c.name;
  }
}

TEST(TileStore, BacksOffBetweenAttempts) {
  const test::TemporaryFolder folder;
  const Outcome o = download(folder.path(), [](const auto&) { return TileReply{.status = 503}; });
  EXPECT_THAT(o.sleeps, testing::ElementsAre(milliseconds(500), milliseconds(1000), milliseconds(2000)));
}

TEST(TileStore, ATileThatDoesNotExistIsNoPhotographAndNoFailure) {
  const test::TemporaryFolder folder;
  const Outcome o = download(folder.path(), bad({.status = 404, .type = "text/html", .body = "<html/>"}));
  EXPECT_EQ(o.error, "");
  EXPECT_EQ(o.report.missing, (std::vector<TileId>{{3, 1, 2}}));
  EXPECT_EQ(o.whole_tiles, 3U);
}

TEST(TileStore, RefusesTilesOfAnotherSourceAndASecondWriter) {
  const test::TemporaryFolder folder;
  const TileSource gsi = find_tile_source("seamlessphoto");
  {
    const TileStore store(folder.path(), gsi);
    store.save({14, 1, 2}, picture(256));
    EXPECT_THROW(TileStore(folder.path(), gsi), Error);
  }
  EXPECT_THROW(TileStore(folder.path(), find_tile_source("pale")), Error);
  EXPECT_NO_THROW(TileStore(folder.path(), gsi));
}

/// An address with a slip in it, or a zoom that the source does not have: nothing is saved, it is said, and
/// another source may be tried.
TEST(TileStore, ASourceThatHasNothingThereIsAnErrorAndMakesRoomForAnother) {
  const test::TemporaryFolder folder;
  const Outcome o = download(folder.path(), [](const auto&) { return TileReply{.status = 404}; });
  EXPECT_THAT(o.error, HasSubstr("has no tile there at zoom 3"));
  {
    const TileStore store(folder.path(), find_tile_source("pale"));
    store.save({14, 1, 2}, picture(256));
  }
  EXPECT_THROW(TileStore(folder.path(), find_tile_source("std")), Error);
  EXPECT_NO_THROW(TileStore(folder.path(), find_tile_source("pale")));
}

TEST(TileStore, ReadsAFolderOfTiles) {
  const test::TemporaryFolder source;
  const test::TemporaryFolder folder;
  fs::create_directories(source.path() / "3" / "1");
  source.write("3/1/1.jpg", picture(256, ".jpg"));
  const TileStore store(folder.path(),
                        find_tile_source("file://" + source.path().string() + "/{z}/{x}/{y}.jpg"));
  const auto report = download_tiles(store, {{3, 1, 1}, {3, 2, 1}}, http_fetcher(), [](milliseconds) {});
  EXPECT_EQ(report.fetched, 1U);
  EXPECT_EQ(report.missing.size(), 1U);
  const std::string png = mosaic_png(store, {{3, 1, 1}, {3, 2, 1}});
  const cv::Mat mosaic = cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_COLOR);
  EXPECT_EQ(mosaic.size(), cv::Size(512, 292));
  EXPECT_THROW((void)mosaic_png(store, {{3, 5, 5}}), Error);
}

TEST(TileSources, KnowTheirNamesAndTemplates) {
  EXPECT_EQ(find_tile_source("ort").url_of({14, 14622, 6017}),
            "https://cyberjapandata.gsi.go.jp/xyz/ort/14/14622/6017.jpg");
  EXPECT_THAT(find_tile_source("std").attribution, HasSubstr("国土地理院"));
  EXPECT_NO_THROW(require_zoom(find_tile_source("std"), 18));
  EXPECT_THROW(require_zoom(find_tile_source("std"), 19), Error);
  EXPECT_THROW((void)find_tile_source("bing"), Error);
  EXPECT_THROW((void)find_tile_source("https://host/{z}/{x}.png"), Error);
  EXPECT_THROW((void)find_tile_source("ftp://host/{z}/{x}/{y}.png"), Error);
}

TEST(TilesAround, CoverTheCircle) {
  EXPECT_EQ(tiles_around({35.464478, 136.739235}, 0.0, 18), (std::vector<TileId>{{18, 230642, 103420}}));
  EXPECT_EQ(tiles_around({35.464478, 136.739235}, 124.5, 18).size(), 9U);
  EXPECT_EQ(tiles_around({0.0, 180.0}, 100.0, 10).size(), 4U);  // date line and equator
  EXPECT_THROW((void)tiles_around({0.0, 0.0}, 1e5, 18), Error);
}

}  // namespace
}  // namespace madori::mapping
