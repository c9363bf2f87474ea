#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <optional>

namespace madori::mapping {

/// While it lives, stderr leads nowhere: image libraries print what the Error of a bad file says already.
class QuietStderr {
 public:
  QuietStderr() {
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    const int copy = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (copy >= 0) ::dup2(nowhere, STDERR_FILENO), kept_ = copy;
    ::close(nowhere);
  }
  ~QuietStderr() {
    if (!kept_) return;
    std::fflush(stderr);
    ::dup2(*kept_, STDERR_FILENO);
    ::close(*kept_);
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  std::optional<int> kept_;
};

}  // namespace madori::mapping
