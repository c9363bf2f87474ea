#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace madori::hmi {

/// The vehicle's cycle comes first, whatever a browser asks for: this thread gets what the cycle leaves. On
/// Linux nice values belong to threads; the cycle's is that of the process.
inline bool run_behind_the_cycle() {
  constexpr int kBehind = 5;
  const int cycle = ::getpriority(PRIO_PROCESS, static_cast<id_t>(::getpid()));
  return ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), cycle + kBehind) == 0;
}

}  // namespace madori::hmi
