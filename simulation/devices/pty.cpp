#include "simulation/devices/pty.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/result.hpp"

namespace madori::simulation {

Pty::Pty(std::filesystem::path link) : link_(std::move(link)) {
  const auto fail = [&](const char* what) {
    const std::string why = std::strerror(errno);
    if (slave_ >= 0) ::close(slave_);
    if (master_ >= 0) ::close(master_);
    throw Error(link_.string(), std::string(what) + ": " + why, "choose a folder that you may write to");
  };
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 128> name{};
  if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
      ::ptsname_r(master_, name.data(), name.size()) != 0)
    fail("no pseudo-terminal");
  slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (slave_ < 0 || ::tcgetattr(slave_, &settings) != 0) fail("no pseudo-terminal");
  ::cfmakeraw(&settings);
  if (::tcsetattr(slave_, TCSANOW, &settings) != 0) fail("cannot be made raw");
  std::error_code error;
  if (std::filesystem::is_symlink(link_, error)) std::filesystem::remove(link_, error);
  std::filesystem::create_symlink(name.data(), link_, error);
  if (error) {
    errno = error.value();
    fail("cannot be linked");
  }
}

Pty::~Pty() {
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
  ::close(slave_);
  ::close(master_);
}

void Pty::write(std::span<const std::uint8_t> bytes) {
  bool flushed = false;
  while (!bytes.empty()) {
    const ssize_t written = ::write(master_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (written < 0 && errno == EINTR) {
      continue;
    } else if (flushed) {
      return;
    } else {
      // Full: nobody reads. The old bytes go, so that whoever opens the port later finds fresh ones.
      flushed = true;
      ::tcflush(slave_, TCIFLUSH);
    }
  }
}

std::size_t Pty::read(std::vector<std::uint8_t>& into) {
  std::array<std::uint8_t, 4096> buffer;
  std::size_t total = 0;
  for (;;) {
    const ssize_t count = ::read(master_, buffer.data(), buffer.size());
    if (count <= 0) return total;
    into.insert(into.end(), buffer.begin(), buffer.begin() + count);
    total += static_cast<std::size_t>(count);
  }
}

}  // namespace madori::simulation
