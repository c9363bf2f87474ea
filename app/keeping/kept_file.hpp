#pragma once

#include <filesystem>
#include <functional>
#include <utility>

#include "mapping/site/file_identity.hpp"

namespace madori::app {

/// A file that a run reads at its start and writes again later. One that somebody else has put there, or
/// taken away, meanwhile (a backup restored, a log learned from) is left as it is: the run knows nothing of
/// it.
class KeptFile {
 public:
  /// Before the run reads it: what is put there from now on is somebody else's.
  explicit KeptFile(std::filesystem::path file)
      : file_(std::move(file)), known_(mapping::file_identity(file_)) {}

  /// Whether it was written, and is this run's.
  bool write(const std::function<void()>& writer) {
    if (mapping::file_identity(file_) != known_) return false;
    writer();
    known_ = mapping::file_identity(file_);
    return true;
  }

 private:
  std::filesystem::path file_;
  mapping::FileIdentity known_;
};

}  // namespace madori::app
