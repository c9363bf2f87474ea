#pragma once

#include <sodium.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/result.hpp"

namespace madori::hmi {

/// An upload lies in a file of its own until the work on it has ended.
class UploadedFile {
 public:
  /// `extension`: with its dot. Throws Error where the disk is full.
  UploadedFile(const std::string& extension, const std::string& content) {
    path_ = std::filesystem::temp_directory_path() / ("madori-upload-" + std::to_string(::getpid()) + "-" +
                                                      std::to_string(randombytes_random()) + extension);
    std::ofstream stream(path_, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!stream.flush()) throw Error(path_.string(), "cannot be written", "free some disk space");
  }
  ~UploadedFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  UploadedFile(const UploadedFile&) = delete;
  UploadedFile& operator=(const UploadedFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The text, with the name that a person knows instead of this file's.
  [[nodiscard]] std::string in_words(std::string text, const std::string& known_as) const {
    const std::string own = path_.string();
    for (auto at = text.find(own); at != std::string::npos; at = text.find(own, at + known_as.size()))
      text.replace(at, own.size(), known_as);
    return text;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace madori::hmi
