// What the panel costs the vehicle's computer: processor time of the server and of what the cycle's thread
// does for it (copying the state, packing the scan), 50 steps a second, a scan of 20,000 points ten times a
// second. The browser is a process of its own. Wanted: at most 5 % of a core with one panel that looks on.
//   cmake --build build/release --target bench_panel && build/release/tests/bench/bench_panel
// How little attacks on the server disturb the cycle: tests/bench/panel_attack.py.
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/lidars.hpp"
#include "app/panel/live_copy.hpp"
#include "app/panel/reference_lidar.hpp"
#include "core/clock.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/server.hpp"
#include "tests/support/panel_client.hpp"
#include "tests/support/scripted_vehicle.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kPoints = 20'000;
constexpr std::chrono::milliseconds kStep{20};
constexpr int kStepsAScan = 5;

double process_cpu_s() {
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

/// A vehicle whose state comes by the way that the cycle's does.
class CopiedVehicle final : public test::ScriptedVehicle {
 public:
  [[nodiscard]] hmi::LiveState live() const override {
    hmi::LiveState live = copy.live();
    live.path = path;
    return live;
  }
  app::LiveCopy copy;
  std::vector<Point2<Map>> path = std::vector<Point2<Map>>(200);
};

PointCloud<Lidar> cloud(double turn_rad) {
  PointCloud<Lidar> scan;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double a = 2.0 * kPi * static_cast<double>(i) / kPoints;
    const double r = 8.0 + 3.0 * std::sin(7.0 * a + turn_rad);
    CloudPoint point;
    point.x_m = static_cast<float>(r * std::cos(a));
    point.y_m = static_cast<float>(r * std::sin(a));
    scan.points.push_back(point);
  }
  return scan;
}

struct Panel {
  Panel() {
    folder.write("index.html", "<!doctype html>");
    files.emplace(folder.path());
    hmi::ServerOptions options;
    options.port = 0;
    server.emplace(options, context, *files);
    for (int i = 0; i < 16; ++i) clouds.push_back(cloud(0.1 * i));
  }

  /// Share of a core that everything took.
  double run(std::chrono::seconds length) {
    const double cpu = process_cpu_s();
    const auto begin = Clock::now();
    auto next = begin;
    for (int step = 0; Clock::now() - begin < length; ++step, next += kStep) {
      std::this_thread::sleep_until(next);
      app::CycleInput input;
      input.now = clock_now();
      // Lent, not copied: the cycle has its scan anyway.
      auto& lent = clouds[static_cast<std::size_t>(step / kStepsAScan) % clouds.size()];
      if (step % kStepsAScan == 0) input.clouds.push_back(std::move(lent));
      vehicle.copy.show_setup(input, {app::lidar_model(app::reference_lidar())}, "");
      if (!input.clouds.empty()) lent = std::move(input.clouds.front());
    }
    return (process_cpu_s() - cpu) / std::chrono::duration<double>(Clock::now() - begin).count();
  }

  test::TemporaryFolder folder;
  hmi::Access access{folder.path() / "pins", false, [] { return Clock::now(); }};
  CopiedVehicle vehicle;
  hmi::Job job;
  hmi::Replay replay;
  hmi::SiteEditor editor{folder.path() / "site"};
  hmi::ApiContext context{access, editor, vehicle, job, replay, [] { return std::string(); }, {}, {}};
  std::optional<hmi::StaticFiles> files;
  std::optional<hmi::Server> server;
  std::vector<PointCloud<Lidar>> clouds;
};

/// A panel that looks on, in another process: prints what came when it is told to end.
class Browser {
 public:
  explicit Browser(unsigned short port) {
    if (::pipe(told_) != 0) return;
    child_ = ::fork();
    if (child_ == 0) look_on(port);
  }
  ~Browser() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Scans that have come since the last call.
  [[nodiscard]] std::size_t scans() const {
    std::size_t count = 0;
    char byte = 0;
    int waiting = 0;
    while (::ioctl(told_[0], FIONREAD, &waiting) == 0 && waiting > 0 && ::read(told_[0], &byte, 1) == 1)
      ++count;
    return count;
  }

 private:
  [[noreturn]] void look_on(unsigned short port) const {
    test::LiveClient client(port, "same");
    while (true) {
      const std::string scan = client.receive_binary();
      const char byte = scan.size() > 4 * kPoints ? 1 : 0;
      if (byte == 0 || ::write(told_[1], &byte, 1) != 1) ::_exit(1);
    }
  }

  int told_[2] = {-1, -1};
  pid_t child_ = -1;
};

}  // namespace
}  // namespace madori

int main() {
  using namespace std::chrono_literals;
  madori::Panel panel;
  (void)panel.run(1s);
  std::printf("nobody looks on: %.2f %% of a core\n", 100.0 * panel.run(15s));
  const madori::Browser browser(panel.server->port());
  (void)panel.run(2s);
  (void)browser.scans();
  const double watched = panel.run(30s);
  std::printf("with one panel:  %.2f %% of a core, %.1f scans of %zu points a second came\n", 100.0 * watched,
              static_cast<double>(browser.scans()) / 30.0, madori::kPoints);
}
