// A backup. The first byte's bits choose: 1, every header gets a right checksum; 2, there is a site already.
// What is restored must be a site, what is refused must leave it as it was, and nothing beside it may change.
#include <algorithm>
#include <cstdio>
#include <string>

#include "hmi/server/site_backup.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/site_versions.hpp"
#include "mapping/wall_map/wall.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace madori;

constexpr std::size_t kBlock = 512, kSize = 124, kSum = 148;

/// Goes from header to header as a reader does.
std::string with_header_sums(std::string tar) {
  for (std::size_t at = 0; at + kBlock <= tar.size();) {
    char* const header = tar.data() + at;
    if (std::all_of(header, header + kBlock, [](char c) { return c == '\0'; })) break;
    std::fill_n(header + kSum, 8, ' ');
    unsigned sum = 0;
    std::for_each_n(header, kBlock, [&](char c) { sum += static_cast<unsigned char>(c); });
    (void)std::snprintf(header + kSum, 7, "%06o", sum);
    const std::string digits(header + kSize, 11);
    const std::size_t size = std::strtoull(digits.c_str(), nullptr, 8);
    if (size > tar.size()) break;
    at += kBlock + (size + kBlock - 1) / kBlock * kBlock;
  }
  return tar;
}

/// As the next commands find the site, and as each of its versions was.
void require_site(const fs::path& site) {
  (void)mapping::load_site(site);
  (void)mapping::load_walls(site / "walls.csv");
  for (const auto& version : mapping::site_versions(site)) try {
      mapping::restore_version(site, version.number);
    } catch (const Error&) {
    }
}

void make_site(const fs::path& site) {
  mapping::SiteTransaction change(site);
  change.write("site.yaml", "madori_site: 1\nname: a\ndrawing: {file: a.png, width_px: 9, height_px: 9}\n");
  change.write("walls.csv", "id,x1,y1,x2,y2\n");
  change.write("tiles/18/5/7.png", "a photograph");
  change.commit();
}

/// Of a folder, what it holds itself.
std::size_t entries_of(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const test::TemporaryFolder folder;
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const fs::path file = folder.write("b.tar", (data[0] & 1U) == 0 ? text : with_header_sums(text));
  const fs::path beside = folder.write("beside", "untouched");
  const fs::path site = folder.path() / "site";
  const bool over = (data[0] & 2U) != 0;
  if (over) make_site(site);
  try {
    (void)hmi::is_backup(file);
    (void)hmi::read_backup(file, site, over);
    require_site(site);
  } catch (const Error& e) {
    fuzz::require(e.what()[0] != '\0' && fs::exists(site / "site.yaml") == over);
    if (over) fuzz::require(mapping::file_content(site / "walls.csv") == "id,x1,y1,x2,y2\n");
  }
  fs::remove_all(site);
  fuzz::require(entries_of(folder.path()) == 2 && fs::file_size(beside) == 9);
  return 0;
}
