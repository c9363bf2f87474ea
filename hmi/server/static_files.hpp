#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "hmi/server/http.hpp"

namespace madori::hmi {

/// The built page, read once at the start, so that no request ever touches the disk or names a path on it.
/// A file `x.gz` beside `x` is sent to browsers that accept gzip.
class StaticFiles {
 public:
  /// Throws Error when `root` has no index.html.
  explicit StaticFiles(const std::filesystem::path& root);

  /// GET and HEAD; "/" is index.html. 404 for all that was not there at the start.
  [[nodiscard]] Response get(const Request& request) const;

 private:
  struct File {
    std::string content_type;
    std::string plain;
    std::string gzip;  ///< empty where there is none
    bool immutable = false;
  };
  std::map<std::string, File> files_;
};

}  // namespace madori::hmi
