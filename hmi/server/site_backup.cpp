#include "hmi/server/site_backup.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <set>

#include "core/result.hpp"
#include "hmi/server/site_files.hpp"
#include "hmi/server/site_snapshot.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/site_versions.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTarBlock = 512;
constexpr std::uint64_t kLargest = 1ULL << 30U;  ///< of one file: drawings are at most 256 MB
using TarBlock = std::array<char, kTarBlock>;

[[noreturn]] void no_backup(const fs::path& file, const std::string& why) {
  throw Error(file.string(), "is no whole backup of a site: " + why, "make it again");
}

std::string text_of(const TarBlock& block, std::size_t at, std::size_t size) {
  const char* begin = block.data() + at;
  return {begin, std::find(begin, begin + size, '\0')};
}

std::uint64_t octal_of(const TarBlock& block, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (const char c : text_of(block, at, size))
    if (c >= '0' && c <= '7') value = value * 8 + static_cast<std::uint64_t>(c - '0');
  return value;
}

bool is_sound(const TarBlock& block) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < kTarBlock; ++i)
    sum += i >= 148 && i < 156 ? static_cast<unsigned char>(' ') : static_cast<unsigned char>(block[i]);
  return sum == octal_of(block, 148, 8) && std::memcmp(block.data() + 257, "ustar", 5) == 0;
}

/// The name inside the site; empty for one that must not be written.
std::string safe_name(const TarBlock& block) {
  const std::string prefix = text_of(block, 345, 155);
  const std::string whole = (prefix.empty() ? "" : prefix + "/") + text_of(block, 0, 100);
  if (!whole.starts_with(kBackupFolder)) return "";
  const std::string name = whole.substr(std::strlen(kBackupFolder));
  return is_in_backup(name) ? name : "";
}

std::string read_content(std::ifstream& stream, std::uint64_t size, const fs::path& file) {
  std::string content(size, '\0');
  const std::uint64_t padding = (kTarBlock - size % kTarBlock) % kTarBlock;
  if (!stream.read(content.data(), static_cast<std::streamsize>(size)) ||
      !stream.ignore(static_cast<std::streamsize>(padding)))
    no_backup(file, "it is cut off");
  return content;
}

bool is_manifest(const std::string& name) {
  return name.starts_with("versions/") && name.ends_with(".json");
}

/// What every later command would refuse.
void require_drivable_routes(const std::map<std::string, std::string>& routes, const fs::path& file) {
  if (routes.empty()) return;
  if (routes.size() != 2) no_backup(file, "one of the two files of its routes is missing");
  const auto parsed = planning::parse_routes(routes.at("routes/tree.csv"), routes.at("routes/path.csv"),
                                             "routes/tree.csv", "routes/path.csv");
  for (const auto& finding : parsed.findings)
    if (finding.severity == planning::Severity::Error) no_backup(file, finding.text());
}

void write_whole(const fs::path& file, TarStream& tar) {
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  bool good = to >= 0;
  for (std::string part = tar.next(); good && !part.empty(); part = tar.next())
    for (std::size_t at = 0; good && at < part.size();) {
      const auto written = ::write(to, part.data() + at, part.size() - at);
      good = written > 0;
      if (good) at += static_cast<std::size_t>(written);
    }
  good = good && ::fsync(to) == 0;
  if (to >= 0) ::close(to);
  if (good) return;
  std::error_code ignored;
  fs::remove(file, ignored);
  throw Error(file.string(), "cannot be written", "check the folder and its free space");
}

}  // namespace

void write_backup(const fs::path& site, const fs::path& file) {
  const fs::path part = file.string() + ".part";
  TarStream tar(site_snapshot(site));
  write_whole(part, tar);
  std::error_code error;
  fs::rename(part, file, error);
  if (error) throw Error(file.string(), "cannot be written: " + error.message(), "check the folder");
}

bool is_backup(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return false;  // reading a pipe or a device may never end
  std::ifstream stream(file, std::ios::binary);
  TarBlock block{};
  return stream.read(block.data(), kTarBlock) && is_sound(block) &&
         text_of(block, 0, 100).starts_with(kBackupFolder);
}

std::size_t read_backup(const fs::path& file, const fs::path& site, bool replace) {
  if (has_site(site) && !replace)
    throw Error(site.string(), "is a site already", "name another folder, or replace it with --force");
  std::error_code none;
  const std::uintmax_t archive = fs::file_size(file, none);
  std::ifstream stream(file, std::ios::binary);
  mapping::SiteTransaction change(site);
  change.say("backup restored");
  std::set<std::string> came;
  std::vector<std::string> manifests;
  std::map<std::string, std::string> routes;
  bool complete = false;
  for (TarBlock block{}; stream.read(block.data(), kTarBlock);) {
    complete = std::ranges::all_of(block, [](char c) { return c == '\0'; });
    if (complete) break;
    if (!is_sound(block)) no_backup(file, "it is damaged");
    const std::uint64_t size = octal_of(block, 124, 12);
    if (size > kLargest) no_backup(file, "a file in it is too large");
    if (size > archive) no_backup(file, "a file in it is larger than the whole");
    const std::string name = safe_name(block);
    const std::string content = read_content(stream, size, file);
    if (name.empty()) continue;
    came.insert(name);
    if (name == "routes/tree.csv" || name == "routes/path.csv") routes[name] = content;
    if (is_manifest(name))
      manifests.push_back(content);
    else
      change.write(name, content);
  }
  if (!complete) no_backup(file, "it is cut off");
  for (const char* name : {"site.yaml", "walls.csv"})
    if (!came.contains(name)) no_backup(file, std::string("it holds no ") + name);
  require_drivable_routes(routes, file);
  mapping::bring_versions(change, site, manifests);
  for (const auto& entry : has_site(site) ? site_entries(site) : std::vector<TarStream::Entry>()) {
    const std::string name = entry.name.substr(std::strlen(kBackupFolder));
    if (!came.contains(name) && !name.starts_with("versions/")) change.remove(name);
  }
  change.commit();
  return came.size();
}

}  // namespace madori::hmi
