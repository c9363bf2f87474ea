#include "app/runner/site_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "core/failure_words.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

/// " (process 123)" as the holder wrote it; empty where it did not.
std::string holder(int file) {
  std::array<char, 16> text{};
  const ssize_t size = ::pread(file, text.data(), text.size() - 1, 0);
  return size > 0 ? " (process " + std::string(text.data(), static_cast<std::size_t>(size)) + ")" : "";
}

}  // namespace

SiteLock::SiteLock(const std::filesystem::path& site, SiteUse use) {
  const bool drives = use == SiteUse::Drive;
  std::error_code error;
  if (drives) std::filesystem::create_directories(site, error);
  const auto name = site / ".run.lock";
  file_ = ::open(name.c_str(), drives ? O_RDWR | O_CREAT | O_CLOEXEC : O_RDONLY | O_CLOEXEC, 0644);
  if (file_ < 0 && !drives && errno == ENOENT) return;  // no program ever drove it
  const std::error_code why(errno, std::generic_category());
  if (file_ < 0)
    throw Error(site.string(), (drives ? "cannot be written: " : "cannot be read: ") + why.message(),
                remedy_of(why));
  if (::flock(file_, (drives ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0) {
    const std::string other = holder(file_);
    ::close(file_);
    if (drives)
      throw Error(site.string(),
                  "another program drives the vehicle of this site already, or changes the site" + other,
                  "end it first, or use its panel");
    throw Error(site.string(),
                "a program drives the vehicle of this site" + other + " and has read what this changes",
                "end it first, or change the site on its panel");
  }
  if (!drives) return;
  const std::string self = std::to_string(::getpid());
  // Who holds it is a help for people alone: a full disk does not matter here.
  if (::ftruncate(file_, 0) == 0) (void)!::pwrite(file_, self.data(), self.size(), 0);
}

SiteLock::~SiteLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace madori::app
