#include "mapping/site/site_versions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/stamp.hpp"
#include "mapping/site/at_once.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/site/site_name.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::mutex author_mutex;                   // NOLINT: of the one author of this program
std::string author_name = "command line";  // NOLINT

struct KeptFile {
  fs::path path;
  std::string object{};  // its name, where that is known
};

/// What each of some files is kept as. Objects never change: one that is there is whole, for it got its name
/// only when it was.
std::vector<std::string> keep_objects(const fs::path& site, const std::vector<KeptFile>& files) {
  const std::vector<std::string> contents =
      at_once(files, [](const KeptFile& file) { return file_content(file.path); });
  std::map<std::string_view, std::string> names;  // a file that came again as it was has its name already
  for (std::size_t i = 0; i < files.size(); ++i)
    if (std::string& name = names[contents[i]]; name.empty()) name = files[i].object;
  at_once(names, [](auto& content) {
    if (content.second.empty()) content.second = object_name(content.first);
  });
  std::map<fs::path, std::string_view> missing;
  for (const auto& [content, name] : names)
    if (const fs::path object = site / "versions/objects" / name; !fs::exists(object))
      missing[object] = content;
  if (!missing.empty()) fs::create_directories(site / "versions/objects");
  at_once(missing, [](const auto& object) { write_file_atomically(object.first, object.second); });
  std::vector<std::string> kept;
  for (const std::string& content : contents) kept.push_back(names.at(content));
  return kept;
}

constexpr std::int64_t kMostNumber = 1'000'000'000;  // leaves numbers for the saves after it

bool is_object(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789abcdef-") == std::string::npos;
}

/// Of a version that this program may have written: a backup brings what anybody wrote.
bool is_possible(const SiteVersion& version) {
  return version.number > 0 && std::ranges::all_of(version.files, [](const auto& file) {
           return is_kept(file.first) && is_object(file.second);
         });
}

SiteVersion parsed(const std::string& manifest) {
  const json all = json::parse(manifest);
  const auto number = all.at("number").is_number_integer() ? all.at("number").get<std::int64_t>() : 0;
  return {number > 0 && number <= kMostNumber ? static_cast<int>(number) : 0, all.at("stamp_s").get<double>(),
          all.at("author").get<std::string>(), all.at("sentence").get<std::string>(),
          all.at("files").get<std::map<std::string, std::string>>()};
}

/// Those that are no manifest are left out: the others count.
std::vector<SiteVersion> readable(const std::vector<std::string>& manifests) {
  std::vector<SiteVersion> all;
  for (const auto& text : manifests) {
    try {
      if (auto version = parsed(text); is_possible(version)) all.push_back(std::move(version));
    } catch (const json::exception&) {
      // not of this program, or damaged
    }
  }
  std::ranges::sort(all, {}, &SiteVersion::number);
  return all;
}

std::string manifest_name(int number) {
  return fmt::format("versions/{:06}.json", number);
}

/// "walls, routes"
std::string words(const std::map<std::string, std::string>& before,
                  const std::map<std::string, std::string>& now) {
  const auto differs = [&](const std::string& name) {
    const auto a = before.find(name), b = now.find(name);
    return (a == before.end()) != (b == now.end()) || (a != before.end() && a->second != b->second);
  };
  const auto drawing = [](const auto& files) {
    const auto found =
        std::ranges::find_if(files, [](const auto& f) { return f.first.starts_with("drawing."); });
    return found == files.end() ? std::string() : found->second;
  };
  std::string text;
  const auto add = [&](const char* word) { text += (text.empty() ? "" : ", ") + std::string(word); };
  if (drawing(before) != drawing(now)) add("drawing");
  if (differs("walls.csv")) add("walls");
  if (differs("routes/tree.csv") || differs("routes/path.csv")) add("routes");
  if (text.empty() || (differs("site.yaml") && drawing(before) == drawing(now))) add("settings");
  return text;
}

/// Names of what belongs to a version and lies in the site now.
std::vector<std::string> kept_now(const fs::path& site) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const char* folder : {".", "routes"})
    for (const auto& entry : fs::directory_iterator(site / folder, missing)) {
      const std::string name = entry.path().lexically_relative(site).lexically_normal().generic_string();
      if (entry.is_regular_file() && is_kept(name)) names.push_back(name);
    }
  return names;
}

std::string manifest(const SiteVersion& version) {
  return json{{"number", version.number},
              {"stamp_s", version.stamp_s},
              {"author", version.author},
              {"sentence", version.sentence},
              {"files", version.files}}
             .dump(1) +
         "\n";
}

std::string author() {
  const std::scoped_lock lock(author_mutex);
  return author_name;
}

}  // namespace

bool is_kept(const std::string& name) {
  return name == "site.yaml" || name == "walls.csv" || name == kOtherLinesFile || name == kWayFile ||
         name == "import.png" || name == "routes/tree.csv" || name == "routes/path.csv" ||
         (name.starts_with("drawing.") && is_site_name(name) && name.find('/') == std::string::npos);
}

bool is_of_versions(const std::string& name) {
  const fs::path path(name);
  const bool manifest = path.parent_path() == "versions" && path.extension() == ".json";
  return manifest || (path.parent_path() == "versions/objects" && is_object(path.filename()));
}

std::string object_name(std::string_view content) {
  __extension__ using Wide = unsigned __int128;
  constexpr Wide kPrime = (static_cast<Wide>(0x1000000) << 64U) + 0x13BU;
  Wide hash = (static_cast<Wide>(0x6C62272E07BB0142ULL) << 64U) + 0x62B821756295C58DULL;
  for (const char c : content) hash = (hash ^ static_cast<unsigned char>(c)) * kPrime;
  return fmt::format("{:016x}{:016x}-{}", static_cast<std::uint64_t>(hash >> 64U),
                     static_cast<std::uint64_t>(hash), content.size());
}

void set_version_author(const std::string& author) {
  const std::scoped_lock lock(author_mutex);
  author_name = author;
}

std::vector<SiteVersion> site_versions(const fs::path& site) {
  std::vector<std::string> manifests;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(site / "versions", missing))
    if (entry.path().extension() == ".json") manifests.push_back(file_content(entry.path()));
  return readable(manifests);
}

SiteVersion site_version(const fs::path& site, int number) {
  for (auto& version : site_versions(site))
    if (version.number == number) return version;
  throw Error(site.string(), "has no version " + std::to_string(number), "list them: madori versions DIR");
}

std::string version_file(const fs::path& site, const SiteVersion& version, const std::string& name) {
  const auto found = version.files.find(name);
  if (found == version.files.end()) return "";
  std::string content = file_content(site / "versions/objects" / found->second);
  if (object_name(content) != found->second)
    throw Error(site.string(), fmt::format("version {} lost its {}, or it is damaged", version.number, name),
                "restore another version, or a backup");
  return content;
}

void stage_version(SiteTransaction& change, const fs::path& site, const fs::path& staging,
                   const StagedFiles& staged) {
  const auto& [puts, removals, known, sentence] = staged;
  if (std::ranges::none_of(puts, is_kept) && std::ranges::none_of(removals, is_kept)) return;
  const auto versions = site_versions(site);
  auto before = versions.empty() ? std::map<std::string, std::string>() : versions.back().files;
  const auto brought = site_versions(staging);  // of a backup, numbered by bring_versions
  const auto& last = brought.empty() ? versions : brought;
  int number = last.empty() ? 0 : last.back().number;
  const auto stage = [&](const std::map<std::string, std::string>& files, const std::string& what) {
    if (files == before) return;
    ++number;
    change.write(manifest_name(number), manifest({number, to_seconds(time_of_day()), author(),
                                                  what.empty() ? words(before, files) : what, files}));
    before = files;
  };
  const std::vector<std::string> now = kept_now(site);
  std::vector<std::string> brought_now;
  std::ranges::copy_if(puts, std::back_inserter(brought_now), is_kept);
  std::vector<KeptFile> kept;
  for (const auto& name : now) kept.push_back({site / name});
  for (const auto& name : brought_now)
    kept.push_back({staging / name, known.contains(name) ? known.at(name) : ""});
  const auto objects = keep_objects(site, kept);
  std::map<std::string, std::string> files;
  for (std::size_t i = 0; i < now.size(); ++i) files[now[i]] = objects[i];
  if (!files.empty())
    stage(files, "as it was found");  // saved by another program, or before there were versions
  else if (!brought.empty())
    before = brought.back().files;  // an empty folder: the backup's last save is what comes now
  for (const auto& name : removals) files.erase(name);
  for (std::size_t i = 0; i < brought_now.size(); ++i) files[brought_now[i]] = objects[now.size() + i];
  stage(files, sentence);
}

void bring_versions(SiteTransaction& change, const fs::path& site,
                    const std::vector<std::string>& manifests) {
  const auto own = site_versions(site);
  int number = own.empty() ? 0 : own.back().number;
  for (SiteVersion& version : readable(manifests)) {
    const auto same = [&](const SiteVersion& one) {
      return one.stamp_s == version.stamp_s && one.files == version.files;
    };
    if (std::ranges::any_of(own, same)) continue;
    version.number = own.empty() ? version.number : ++number;
    change.write(manifest_name(version.number), manifest(version));
  }
}

void restore_version(const fs::path& site, int number) {
  const SiteVersion version = site_version(site, number);
  SiteTransaction change(site);
  change.say("version " + std::to_string(number) + " restored");
  for (const auto& [name, object] : version.files) change.write(name, version_file(site, version, name));
  const auto versions = site_versions(site);
  for (const auto& [name, object] : versions.back().files)
    if (!version.files.contains(name)) change.remove(name);
  if (version.files.contains("site.yaml") && version.files.contains("walls.csv")) {
    const Site record = change.said_of_site([&] { return read_site_file(change.staged("site.yaml")); });
    const double unit = record.scale ? record.scale->m_per_px : 1.0;
    const std::string walls = file_content(change.staged("walls.csv"));
    const Walls lines = change.said_of_site([&] { return load_walls(change.staged("walls.csv")); });
    (void)stage_wall_files(change, lines, record.drawing.width_px * unit, record.drawing.height_px * unit,
                           record.scale ? WallFileOptions{} : WallFileOptions::unscaled());
    change.write("walls.csv", walls);  // with its probabilities
  }
  change.commit();
}

}  // namespace madori::mapping
