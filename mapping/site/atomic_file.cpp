#include "mapping/site/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <optional>
#include <string>

#include "core/failure_words.hpp"
#include "core/result.hpp"

namespace madori::mapping {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  const std::error_code why(errno, std::generic_category());
  throw Error(file.string(), what + ": " + why.message(), remedy_of(why));
}

/// Writes, syncs where that is wanted, and closes; false with errno on failure.
bool write_and_close(int descriptor, std::string_view content, bool sync) {
  bool good = true;
  while (good && !content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    good = written > 0;
    if (good) content.remove_prefix(static_cast<std::size_t>(written));
  }
  good = good && (!sync || ::fsync(descriptor) == 0);
  const int error = errno;
  good = ::close(descriptor) == 0 && good;
  if (!good && error != 0) errno = error;
  return good;
}

constexpr mode_t kForAll = 0644, kForOwner = 0600;

/// Writes `path` anew; on failure it is removed and the Error names `file`. With these permissions, or those
/// of a new file.
void write_whole(const std::string& path, const std::filesystem::path& file, std::string_view content,
                 bool sync, std::optional<mode_t> mode = {}) {
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode ? kForOwner : kForAll);
  if (descriptor < 0) fail(file, "cannot be written");
  if (mode) (void)::fchmod(descriptor, *mode);
  errno = 0;
  if (write_and_close(descriptor, content, sync)) return;
  const int error = errno;
  ::unlink(path.c_str());
  errno = error;
  fail(file, "cannot be written");
}

/// A device, a pipe or a terminal: in place, and without a sync that many of them do not know.
void write_into(const std::filesystem::path& file, std::string_view content) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  errno = descriptor < 0 ? errno : 0;
  if (descriptor < 0 || !write_and_close(descriptor, content, false)) fail(file, "cannot be written");
}

/// What a chain of symbolic links leads to; it need not exist.
std::filesystem::path end_of_links(std::filesystem::path file) {
  constexpr int kMostLinks = 40;  // as the kernel follows
  std::error_code none;
  for (int links = 0; links < kMostLinks && std::filesystem::is_symlink(file, none); ++links) {
    const auto to = std::filesystem::read_symlink(file, none);
    file = to.is_absolute() ? to : file.parent_path() / to;
  }
  return file;
}

std::string temporary_of(const std::filesystem::path& file) {
  return file.string() + ".tmp" + std::to_string(::getpid());
}

}  // namespace

void expect_writable(const std::filesystem::path& named) {
  struct stat there {};
  const bool is_special = ::stat(named.c_str(), &there) == 0 && !S_ISREG(there.st_mode);
  if (is_special) {  // opening a pipe would wait for its reader
    errno = S_ISDIR(there.st_mode) ? EISDIR : 0;
    if (errno != 0 || ::access(named.c_str(), W_OK) != 0) fail(named, "cannot be written");
    return;
  }
  const std::string temporary = temporary_of(end_of_links(named));
  write_whole(temporary, named, "", false);
  ::unlink(temporary.c_str());
}

void write_new_file(const std::filesystem::path& file, std::string_view content) {
  write_whole(file.string(), file, content, false);
}

void write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> content) {
  write_file_atomically(file,
                        std::string_view(reinterpret_cast<const char*>(content.data()), content.size()));
}

void write_file_atomically(const std::filesystem::path& named, std::string_view content, Secrecy secrecy) {
  struct stat there {};
  const bool exists = ::stat(named.c_str(), &there) == 0;
  if (exists && !S_ISREG(there.st_mode)) return write_into(named, content);
  std::optional<mode_t> mode;
  if (exists) mode = there.st_mode & 0777U;
  if (secrecy == Secrecy::OwnerOnly) mode = kForOwner;
  const std::filesystem::path file = end_of_links(named);
  const std::string temporary = temporary_of(file);
  write_whole(temporary, named, content, true, mode);
  if (::rename(temporary.c_str(), file.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary.c_str());
    errno = error;
    fail(file, "cannot be written");
  }
  const auto parent = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int folder = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

std::string file_content(const std::filesystem::path& file) {
  constexpr std::size_t kBlock = std::size_t{1} << 18U;
  std::ifstream stream(file, std::ios::binary);
  std::string content;
  if (!stream && errno != ENOENT && errno != ENOTDIR) fail(file, "cannot be read");
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  if (!unknown) content.reserve(size + kBlock);
  for (std::size_t read = 0; stream; content.resize(read)) {
    content.resize(read + kBlock);
    stream.read(content.data() + read, static_cast<std::streamsize>(kBlock));
    read += static_cast<std::size_t>(stream.gcount());
  }
  if (stream.bad()) fail(file, "cannot be read");
  return content;
}

}  // namespace madori::mapping
