#include "hmi/server/site_snapshot.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "core/result.hpp"
#include "hmi/server/site_files.hpp"
#include "mapping/site/site_name.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/site_versions.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

/// What a save replaces. The others never change once they are there, or stand alone.
bool is_replaced(const std::string& name) {
  const std::string in_site = name.substr(std::strlen(kBackupFolder));
  return !in_site.starts_with("versions/") && !in_site.starts_with("tiles/") &&
         !in_site.starts_with("learned/days/");
}

/// Whether the site still has these files, those held included.
bool are_still(const std::vector<TarStream::Entry>& entries, const fs::path& site) {
  const auto now = site_entries(site);
  return std::ranges::equal(now, entries, {}, &TarStream::Entry::name, &TarStream::Entry::name) &&
         std::ranges::all_of(entries, [](const TarStream::Entry& entry) {
           return !is_replaced(entry.name) || (entry.held && entry.held->is_still(entry.file));
         });
}

}  // namespace

bool is_in_backup(const std::string& name) {
  if (!mapping::is_site_name(name)) return false;
  if (name.starts_with("versions/")) return mapping::is_of_versions(name);
  if (name.find('/') != std::string::npos)
    return name.starts_with("routes/") || name.starts_with("tiles/") || name.starts_with("learned/");
  return mapping::is_kept(name) || name == "reliability.csv" || name == "memory.bin" ||
         name == "self_calibration.yaml" || name.starts_with("walls.") || name.starts_with("map.");
}

/// Only where a backup has files: a change that is being staged and recordings come and go below the others.
std::vector<TarStream::Entry> site_entries(const fs::path& site) {
  std::vector<TarStream::Entry> entries;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(site, missing))
    if (entry.is_regular_file() && !entry.is_symlink())
      entries.push_back({entry.path(), kBackupFolder + entry.path().filename().string()});
  for (const char* folder : {"learned", "routes", "tiles", "versions"})
    if (!fs::is_symlink(site / folder, missing))
      std::ranges::move(tar_entries(site / folder, std::string(kBackupFolder) + folder + "/"),
                        std::back_inserter(entries));
  std::erase_if(entries, [](const TarStream::Entry& entry) {
    return !is_in_backup(entry.name.substr(std::strlen(kBackupFolder)));
  });
  std::ranges::sort(entries, {}, &TarStream::Entry::name);
  return entries;
}

std::vector<TarStream::Entry> site_snapshot(const fs::path& site) {
  if (!has_site(site)) throw Error(site.string(), "is no site folder (no site.yaml)", "name a site");
  if (!fs::exists(site / "walls.csv"))
    throw Error(site.string(), "has no walls.csv, without which it is no site", "import its drawing again");
  const auto read = [&] {
    auto entries = site_entries(site);
    for (auto& entry : entries)
      if (is_replaced(entry.name)) entry.held = HeldFile::open(entry.file);
    return entries;
  };
  return mapping::read_unchanged(site, read, [&](const auto& entries) { return are_still(entries, site); });
}

}  // namespace madori::hmi
