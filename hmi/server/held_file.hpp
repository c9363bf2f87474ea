#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace madori::hmi {

/// A file as it was when it was opened: a site's files are replaced, never written into, so that whoever
/// holds one open goes on reading what it was.
class HeldFile {
 public:
  /// Null where it cannot be opened.
  [[nodiscard]] static std::shared_ptr<HeldFile> open(const std::filesystem::path& file);
  ~HeldFile();
  HeldFile(const HeldFile&) = delete;
  HeldFile& operator=(const HeldFile&) = delete;

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint64_t modified_s() const { return modified_s_; }
  /// Whether the path still leads to this one.
  [[nodiscard]] bool is_still(const std::filesystem::path& file) const;
  /// The next bytes, less than asked for at its end or where it cannot be read.
  [[nodiscard]] std::string read(std::size_t most);

 private:
  explicit HeldFile(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
  std::uint64_t size_ = 0, modified_s_ = 0;
};

}  // namespace madori::hmi
