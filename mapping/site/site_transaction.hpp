#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace madori::mapping {

/// Changes several files of a site folder in one atomic step. Files are staged below DIR/.staging and synced;
/// commit() writes a journal, and from then on the change happens even when the power fails: whoever opens
/// the site next finishes it (`recover_site`). Without a commit nothing of the site changes.
class SiteTransaction {
 public:
  /// Creates the folder where it is missing. Throws Error when another command is changing the site.
  explicit SiteTransaction(std::filesystem::path site);
  /// Discards what was not committed; a folder that was created for it is removed again.
  ~SiteTransaction();
  SiteTransaction(const SiteTransaction&) = delete;
  SiteTransaction& operator=(const SiteTransaction&) = delete;

  /// Where to write the new version of `name` (relative, may have folders); counts as part of the change.
  [[nodiscard]] std::filesystem::path staged(const std::string& name);
  /// Its syncing, and naming its content for a version, begin at once, beside what the caller does next.
  void write(const std::string& name, std::string_view content);
  /// The file disappears with the commit; a missing one is fine.
  void remove(const std::string& name);
  /// What this change is, for the list of versions; otherwise the files that change say it.
  void say(const std::string& sentence) { sentence_ = sentence; }
  /// All or nothing, with a version of the site (site_versions.hpp). What would become site.yaml or walls.csv
  /// is read back first, as the next command will. Throws Error (it cannot be read, disk full, no permission)
  /// with the site as it was.
  void commit();
  /// work(), which reads or writes what is staged; an Error of it names the site's files instead of those.
  template <class Work>
  auto said_of_site(const Work& work) const {
    try {
      return work();
    } catch (const Error& e) {
      throw Error(of_site(e.what()));
    }
  }

 private:
  [[nodiscard]] std::string of_site(std::string text) const;
  void read_back() const;
  void sync_staged();

  std::filesystem::path site_;
  std::vector<std::string> puts_;
  std::vector<std::string> removals_;
  std::string sentence_;
  std::map<std::string, std::future<std::string>> objects_;  // by their names, those of a version
  std::map<std::string, std::future<void>> syncs_;
  int lock_ = -1;
  bool created_ = false;
  bool committed_ = false;
};

/// Whether a change was committed and its files are not all in place yet.
[[nodiscard]] bool is_being_changed(const std::filesystem::path& site);

/// Finishes a change that was committed but cut short. Cheap when there is nothing to do.
void recover_site(const std::filesystem::path& site);

/// What read() gives of files that are all of one state of the site: anew as long as `still`(that) is false,
/// or a change is under way, for a save in between is rare, and asks for one more. Throws what read() throws,
/// and Error where the site is being changed all the time.
template <class Read, class Still>
auto read_unchanged(const std::filesystem::path& site, const Read& read, const Still& still) {
  constexpr int kMostTries = 100;
  for (int tries = 0; tries < kMostTries; ++tries) {
    recover_site(site);
    auto found = read();
    if (!is_being_changed(site) && still(found)) return found;
  }
  throw Error(site.string(), "is being changed all the time", "try again");
}

}  // namespace madori::mapping
