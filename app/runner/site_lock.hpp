#pragma once

#include <filesystem>

namespace madori::app {

/// Held by the one program that drives the vehicle of a site: SITE/.run.lock (flock). The kernel gives it up
/// when the program ends, however it ends.
class SiteLock {
 public:
  /// Makes the folder where it is missing. Throws Error, naming the other program, where one drives this
  /// site.
  explicit SiteLock(const std::filesystem::path& site);
  ~SiteLock();
  SiteLock(const SiteLock&) = delete;
  SiteLock& operator=(const SiteLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace madori::app
