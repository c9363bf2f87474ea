#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::fuzz {

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// A file in memory that code which wants a path can open.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& extension) : descriptor_(::memfd_create("fuzz", 0)) {
    require(descriptor_ >= 0);
    const auto folder = std::filesystem::temp_directory_path();
    path_ = folder / ("madori-fuzz-" + std::to_string(::getpid()) + extension);
    std::filesystem::remove(path_);
    std::filesystem::create_symlink(
        "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(descriptor_), path_);
  }
  ~MemoryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void write(const std::uint8_t* data, std::size_t size) const {
    require(::ftruncate(descriptor_, 0) == 0);
    require(::pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size));
  }
  void write(std::string_view text) const {
    write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  int descriptor_;
  std::filesystem::path path_;
};

inline void check(const mapping::GrayImage& image) {
  require(image.width_px > 0 && image.height_px > 0);
  require(image.pixels.size() ==
          static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
}

}  // namespace madori::fuzz
