#pragma once

#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <utility>

namespace madori::app {

/// A file that a run reads at its start and writes again later. One that somebody else has put there, or
/// taken away, meanwhile (a backup restored, a log learned from) is left as it is: the run knows nothing of
/// it.
class KeptFile {
 public:
  explicit KeptFile(std::filesystem::path file) : file_(std::move(file)), known_(identity()) {}

  /// Whether it was written, and is this run's.
  bool write(const std::function<void()>& writer) {
    if (identity() != known_) return false;
    writer();
    known_ = identity();
    return true;
  }

 private:
  using Identity = std::array<std::int64_t, 5>;

  /// All zero where there is none.
  [[nodiscard]] Identity identity() const {
    struct stat s {};
    if (::stat(file_.c_str(), &s) != 0) return {};
    return {static_cast<std::int64_t>(s.st_dev), static_cast<std::int64_t>(s.st_ino), s.st_size,
            s.st_mtim.tv_sec, s.st_mtim.tv_nsec};
  }

  std::filesystem::path file_;
  Identity known_;
};

}  // namespace madori::app
