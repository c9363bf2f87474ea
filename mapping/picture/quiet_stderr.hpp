#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace madori::mapping {

/// While one lives, in whatever thread, stderr leads nowhere: image libraries print what the Error of a bad
/// file says already. The last one to go gives it back, so that two that overlap do not take each other's
/// nowhere for what there was before.
class QuietStderr {
 public:
  QuietStderr() {
    const std::scoped_lock lock(mutex_);
    if (living_++ > 0) return;
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    kept_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (kept_ >= 0) ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~QuietStderr() {
    const std::scoped_lock lock(mutex_);
    if (--living_ > 0 || kept_ < 0) return;
    std::fflush(stderr);
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
    kept_ = -1;
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  inline static std::mutex mutex_;
  inline static int living_ = 0;
  inline static int kept_ = -1;  ///< what stderr was
};

}  // namespace madori::mapping
