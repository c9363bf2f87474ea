#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace madori {

/// What hangs on a thread of a running vehicle.
enum class ThreadRole {
  Behind,    ///< gets what the others leave: what a browser asked for, pictures, what is learned
  Ordinary,  ///< what the cycle wants soon, but does not wait for
  Cycle,     ///< the drive's next command
  Device     ///< a device's bytes and their times of arrival: short work, before the cycle's
};

/// Names the calling thread for people who look at the process (15 characters count), and gives it its place.
/// Cycle and devices come before all ordinary work (SCHED_FIFO) where the computer permits it: root,
/// CAP_SYS_NICE or RLIMIT_RTPRIO; threads that they start are ordinary ones again. On Linux nice values
/// belong to threads. Returns whether it has its place.
inline bool take_role(const char* name, ThreadRole role) {
  constexpr int kNiceBehind = 5;
  constexpr int kUrgent = 10;  ///< far below the kernel's own threads, which serve the devices
  char cut[16] = {};
  for (int i = 0; i < 15 && name[i] != '\0'; ++i) cut[i] = name[i];
  pthread_setname_np(pthread_self(), cut);
  if (role == ThreadRole::Ordinary) {
    const sched_param none{};
    return sched_setscheduler(0, SCHED_OTHER, &none) == 0;
  }
  if (role == ThreadRole::Behind) {
    const int usual = getpriority(PRIO_PROCESS, static_cast<id_t>(getpid()));
    return setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), usual + kNiceBehind) == 0;
  }
  const sched_param place{.sched_priority = role == ThreadRole::Device ? kUrgent + 1 : kUrgent};
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &place) == 0;
}

/// Keeps the program's memory from being swapped out, now and later, where the computer permits it without a
/// limit: with one, later allocations would fail. Returns whether it is kept.
inline bool lock_memory() {
  rlimit limit{};
  const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  return unlimited && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

}  // namespace madori
