#include "mapping/site/site_transaction.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/failure_words.hpp"
#include "core/result.hpp"
#include "mapping/site/at_once.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/site/site_name.hpp"
#include "mapping/site/site_versions.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStaging = ".staging";
constexpr const char* kLock = ".staging.lock";
constexpr const char* kJournal = "JOURNAL";

fs::path journal_of(const fs::path& site) {
  return site / kStaging / kJournal;
}

void sync(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::error_code why(errno, std::generic_category());
  if (descriptor >= 0) ::close(descriptor);
  if (!good) throw Error(path.string(), "cannot be saved: " + why.message(), remedy_of(why));
}

int take_lock(const fs::path& site, bool wait) {
  const fs::path file = site / kLock;
  const int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  const std::error_code why(errno, std::generic_category());
  if (lock < 0) throw Error(site.string(), "cannot be written: " + why.message(), remedy_of(why));
  if (::flock(lock, wait ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
    ::close(lock);
    throw Error(site.string(), "another command is changing this site", "wait until it has ended");
  }
  return lock;
}

void require_site_name(const fs::path& site, const std::string& name) {
  if (!is_site_name(name))
    throw Error(site.string(), "has no file of the name " + name, "choose another name");
}

/// Whether both are there on one disk: nothing is renamed from one to another.
bool are_on_one_disk(const fs::path& a, const fs::path& b) {
  struct stat one {};
  struct stat other {};
  return ::stat(a.c_str(), &one) == 0 && ::stat(b.c_str(), &other) == 0 && one.st_dev == other.st_dev;
}

/// What was committed must come to pass: a folder where a file is to be, or where its folder is to be a file
/// or a link to nothing or to another disk, would stop it half way, and every command after it.
void require_room_for(const fs::path& site, const std::string& name) {
  bool free = !fs::is_directory(site / name);
  for (fs::path part = fs::path(name).parent_path(); free && !part.empty(); part = part.parent_path())
    free = !fs::exists(fs::symlink_status(site / part)) ||
           (fs::is_directory(site / part) && are_on_one_disk(site / part, site / kStaging));
  if (!free)
    throw Error((site / name).string(),
                "cannot be written: a file or folder of the site is in its way, or its folder is a link to "
                "another disk",
                "move that away");
  if (fs::is_symlink(site / name)) expect_writable(site / name);
}

/// People link what several sites share, to another disk too: a link stays, and the file it leads to is
/// replaced.
void put(const fs::path& staged, const fs::path& file) {
  std::error_code failed;
  const bool linked = fs::is_symlink(file);
  if (!linked) fs::rename(staged, file, failed);
  if (!linked && !failed) return;
  if (failed && failed != std::errc::cross_device_link)
    throw fs::filesystem_error("cannot rename", file, staged, failed);
  write_file_atomically(file, file_content(staged));
  fs::remove(staged);
}

/// Every step can be repeated: a rename that was done before the power failed is simply no longer there.
void apply_journal(const fs::path& site) {
  std::ifstream journal(journal_of(site));
  std::string line;
  while (std::getline(journal, line)) {
    const std::string name = line.substr(std::min<std::size_t>(line.size(), 2));
    if (line.starts_with("- ")) {
      std::error_code missing;
      fs::remove(site / name, missing);
    } else if (line.starts_with("+ ") && fs::exists(site / kStaging / name)) {
      fs::create_directories((site / name).parent_path());
      put(site / kStaging / name, site / name);
    }
  }
  sync(site);
  fs::remove_all(site / kStaging);
}

}  // namespace

SiteTransaction::SiteTransaction(fs::path site) : site_(std::move(site)) {
  std::error_code error;
  created_ = fs::create_directories(site_, error);
  if (error) throw Error(site_.string(), "cannot be made: " + error.message(), remedy_of(error));
  lock_ = take_lock(site_, false);
  try {
    if (fs::exists(journal_of(site_))) apply_journal(site_);
    fs::remove_all(site_ / kStaging, error);
    fs::create_directories(site_ / kStaging, error);
    if (error) throw Error(site_.string(), "cannot be written: " + error.message(), remedy_of(error));
  } catch (...) {
    ::close(lock_);  // else a panel would say until its end that another command changes the site
    throw;
  }
}

SiteTransaction::~SiteTransaction() {
  std::error_code ignored;
  syncs_.clear(), objects_.clear();  // waits for them
  if (!committed_) {
    fs::remove_all(site_ / kStaging, ignored);
    if (created_) fs::remove(site_ / kLock, ignored);
    if (created_) fs::remove(site_, ignored);  // only where it is still empty
  }
  ::close(lock_);
}

fs::path SiteTransaction::staged(const std::string& name) {
  require_site_name(site_, name);
  if (std::find(puts_.begin(), puts_.end(), name) == puts_.end()) puts_.push_back(name);
  syncs_.erase(name), objects_.erase(name);  // of what is there now
  fs::path file = site_ / kStaging / name;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) throw Error((site_ / name).string(), "cannot be written: " + error.message(), remedy_of(error));
  return file;
}

std::string SiteTransaction::of_site(std::string text) const {
  const std::string staging = (site_ / kStaging).string();
  for (auto at = text.find(staging); at != std::string::npos; at = text.find(staging))
    text.replace(at, staging.size(), site_.string());
  return text;
}

void SiteTransaction::write(const std::string& name, std::string_view content) {
  const fs::path file = staged(name);
  said_of_site([&] { write_new_file(file, content); });
  syncs_[name] = std::async(std::launch::async, sync, file);
  if (is_kept(name))
    objects_[name] =
        std::async(std::launch::async, [text = std::string(content)] { return object_name(text); });
}

void SiteTransaction::sync_staged() {
  std::vector<std::string> others;
  std::ranges::copy_if(puts_, std::back_inserter(others),
                       [&](const std::string& name) { return !syncs_.contains(name); });
  at_once(others, [&](const std::string& name) { sync(site_ / kStaging / name); });
  for (auto& [name, synced] : syncs_) synced.get();
  syncs_.clear();
}

void SiteTransaction::remove(const std::string& name) {
  require_site_name(site_, name);
  removals_.push_back(name);
}

/// Whatever was staged must not make a site that every later command refuses.
void SiteTransaction::read_back() const {
  const auto put = [this](const char* name) { return std::ranges::find(puts_, name) != puts_.end(); };
  said_of_site([&] {
    if (put("site.yaml")) (void)read_site_file(site_ / kStaging / "site.yaml");
    if (put("walls.csv")) (void)load_walls(site_ / kStaging / "walls.csv");
  });
}

void SiteTransaction::commit() {
  read_back();
  for (const auto& name : puts_) require_room_for(site_, name);
  std::map<std::string, std::string> objects;
  for (auto& [name, object] : objects_) objects[name] = object.get();
  objects_.clear();
  stage_version(*this, site_, site_ / kStaging, {puts_, removals_, objects, sentence_});
  said_of_site([&] { sync_staged(); });
  std::string journal;
  for (const auto& name : removals_) journal += "- " + name + "\n";
  for (const auto& name : puts_) journal += "+ " + name + "\n";
  write_file_atomically(journal_of(site_), journal);
  committed_ = true;
  apply_journal(site_);
}

bool is_being_changed(const fs::path& site) {
  std::error_code missing;
  return fs::exists(journal_of(site), missing);
}

void recover_site(const fs::path& site) {
  if (!fs::exists(journal_of(site))) return;
  const int lock = take_lock(site, true);
  try {
    if (fs::exists(journal_of(site))) apply_journal(site);
  } catch (...) {
    ::close(lock);  // load_site would wait for it for ever
    throw;
  }
  ::close(lock);
}

}  // namespace madori::mapping
