#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hmi/server/held_file.hpp"
#include "hmi/server/http.hpp"

namespace madori::hmi {

/// Files as one tar archive (POSIX ustar), read part by part, so that no download has to fit into memory. A
/// file that grows meanwhile is cut at the length it had.
class TarStream {
 public:
  struct Entry {
    std::filesystem::path file;
    std::string name;                  ///< in the archive, at most 255 characters
    std::shared_ptr<HeldFile> held{};  ///< null: opened when its turn comes, left out if it is gone
  };
  explicit TarStream(std::vector<Entry> entries) : entries_(std::move(entries)) {}

  /// The next bytes, at most 64 KiB; empty at the end. Throws Error where a file ends before its length: an
  /// archive with a hole must not look whole.
  [[nodiscard]] std::string next();

 private:
  std::vector<Entry> entries_;
  std::size_t at_ = 0;
  std::shared_ptr<HeldFile> open_;
  std::uint64_t left_ = 0;   ///< of the file that is open
  std::size_t padding_ = 0;  ///< after it
  bool ended_ = false;
};

/// The archive as a download.
[[nodiscard]] Response tar_response(std::vector<TarStream::Entry> entries, const std::string& file_name);

/// Every regular file below `folder`, by name. Symbolic links are left out: they may lead anywhere.
[[nodiscard]] std::vector<TarStream::Entry> tar_entries(const std::filesystem::path& folder,
                                                        const std::string& prefix);

}  // namespace madori::hmi
