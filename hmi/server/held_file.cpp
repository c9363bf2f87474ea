#include "hmi/server/held_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace madori::hmi {

std::shared_ptr<HeldFile> HeldFile::open(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  std::shared_ptr<HeldFile> held(new HeldFile(descriptor));
  struct stat now {};
  if (::fstat(descriptor, &now) != 0 || !S_ISREG(now.st_mode)) return nullptr;
  held->size_ = static_cast<std::uint64_t>(now.st_size);
  held->modified_s_ = static_cast<std::uint64_t>(std::max<std::int64_t>(0, now.st_mtime));
  return held;
}

HeldFile::~HeldFile() {
  ::close(descriptor_);
}

bool HeldFile::is_still(const std::filesystem::path& file) const {
  struct stat mine {};
  struct stat there {};
  return ::fstat(descriptor_, &mine) == 0 && ::stat(file.c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

std::string HeldFile::read(std::size_t most) {
  std::string bytes(most, '\0');
  std::size_t got = 0;
  while (got < most) {
    const auto now = ::read(descriptor_, bytes.data() + got, most - got);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) break;
    got += static_cast<std::size_t>(now);
  }
  bytes.resize(got);
  return bytes;
}

}  // namespace madori::hmi
