#include "app/runner/watchdog.hpp"

#include <fmt/format.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <fstream>
#include <utility>

#include "core/thread_role.hpp"

namespace madori::app {
namespace {

std::string line_of(int thread, const char* file) {
  std::ifstream in(fmt::format("/proc/self/task/{}/{}", thread, file));
  std::string line;
  std::getline(in, line);
  return line;
}

/// What a thread is about, by the state that the kernel gives it (proc(5), field 3 of stat).
std::string doing(int thread) {
  const std::string stat = line_of(thread, "stat");
  const std::size_t named = stat.rfind(')');  // a name may hold anything
  const char state = named + 2 < stat.size() ? stat[named + 2] : '?';
  if (state == 'R') return "it computes";
  if (state == 'D') return "it waits for the disk or a device";
  return "it waits for another thread, a file or the network";
}

}  // namespace

long long Watchdog::now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

Watchdog::Watchdog(WatchdogOptions options)
    : options_(std::move(options)),
      watched_(static_cast<int>(gettid())),
      beat_ns_(now_ns()),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void Watchdog::watch(const std::stop_token& stop) {
  (void)take_role("watchdog", ThreadRole::Device);  // a cycle that never sleeps must not keep it from looking
  sd_notify(0, "READY=1");
  bool hangs = false;
  auto notified = std::chrono::steady_clock::time_point{};
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(options_.look_every);
    const std::chrono::nanoseconds since(now_ns() - beat_ns_.load(std::memory_order_relaxed));
    const bool late = since > options_.hung_after;
    if (!late && std::chrono::steady_clock::now() - notified >= options_.notify_every) {
      sd_notify(0, "WATCHDOG=1");
      notified = std::chrono::steady_clock::now();
    }
    if (late && !hangs)
      options_.told(fmt::format(
          "thread \"{}\" has not come round for {:.1f} s ({}): the drive has stopped by itself",
          line_of(watched_, "comm"), std::chrono::duration<double>(since).count(), doing(watched_)));
    if (!late && hangs) options_.told("the thread that hung comes round again");
    hangs = late;
  }
  sd_notify(0, "STOPPING=1");
}

}  // namespace madori::app
