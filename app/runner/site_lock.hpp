#pragma once

#include <filesystem>

namespace madori::app {

/// What a program wants with a site.
enum class SiteUse {
  Drive,   ///< its vehicle: one program alone
  Change,  ///< what a driving program has read and would go on believing: drawing, scale, mountings, what was
           ///< learned. Several may: mapping::SiteTransaction lets them take turns
};

/// SITE/.run.lock (flock). The kernel gives it up when the program ends, however it ends.
class SiteLock {
 public:
  /// To drive it makes the folder where it is missing. Throws Error, naming the other program, where one
  /// drives this site; to drive also where one changes it.
  explicit SiteLock(const std::filesystem::path& site, SiteUse use = SiteUse::Drive);
  ~SiteLock();
  SiteLock(const SiteLock&) = delete;
  SiteLock& operator=(const SiteLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace madori::app
