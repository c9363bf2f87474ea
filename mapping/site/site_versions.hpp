#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace madori::mapping {

class SiteTransaction;

/// One save of a site.
struct SiteVersion {
  int number = 0;
  double stamp_s = 0.0;                      ///< time of day
  std::string author;                        ///< who changed it: a panel, the command line
  std::string sentence;                      ///< what changed
  std::map<std::string, std::string> files;  ///< name in the site -> object in versions/objects
};

/// What a change puts and takes away, and what is known of it.
struct StagedFiles {
  const std::vector<std::string>&puts, &removals;
  const std::map<std::string, std::string>& objects;  ///< what is known of the puts: name -> object_name
  const std::string& sentence;
};

/// Every save of a site, below DIR/versions: `objects/` holds each content once, named by its hash and never
/// changed, `NNNNNN.json` names the objects of a version. SiteTransaction stages a version with every change,
/// so that the change and its version happen together or not at all; what can be computed from walls.csv
/// (walls.pcd, map.pgm) is not kept.
/// Stages the version that `change` will make: `puts` are staged below the folder `staging`, `removals` go.
/// Nothing where no file of a version changes.
void stage_version(SiteTransaction& change, const std::filesystem::path& site,
                   const std::filesystem::path& staging, const StagedFiles& files);

/// The way that was driven when a site was mapped: time_s,x_m,y_m,yaw_rad, Map frame. No other map's.
inline constexpr const char* kWayFile = "driven_way.csv";

/// Whether a file of a site belongs to its versions.
[[nodiscard]] bool is_kept(const std::string& name);
/// Whether a file below a site's `versions` is a manifest or an object, by its name in the site.
[[nodiscard]] bool is_of_versions(const std::string& name);
/// The name of a content below versions/objects: FNV-1a of 128 bits, and the length; keeps no secret.
[[nodiscard]] std::string object_name(std::string_view content);

/// Stages the versions of a backup, given as the manifests that it holds: behind the site's own, those left
/// out that the site has, or that cannot be read. In a folder without versions they keep their numbers.
void bring_versions(SiteTransaction& change, const std::filesystem::path& site,
                    const std::vector<std::string>& manifests);

/// All versions, oldest first; manifests that are damaged, or name what no version keeps, are left out.
[[nodiscard]] std::vector<SiteVersion> site_versions(const std::filesystem::path& site);
/// Throws Error where there is no such version.
[[nodiscard]] SiteVersion site_version(const std::filesystem::path& site, int number);
/// The content of a file of a version; empty where it had none. Throws Error where it is lost, or is not what
/// was kept: a disk that errs, a backup that was changed.
[[nodiscard]] std::string version_file(const std::filesystem::path& site, const SiteVersion& version,
                                       const std::string& name);
/// Makes the site what it was, as a new version. Throws Error.
void restore_version(const std::filesystem::path& site, int number);

/// Who the saves of this program are by.
void set_version_author(const std::string& author);

}  // namespace madori::mapping
