// The panel's server beside the vehicle's cycle, on real sockets; the browser and the attacker are processes
// of their own. Two questions:
//   bench_panel live     processor time of the server (and of packing the scans) with one panel that looks on
//                        at 10 Hz x 20,000 points; wanted: at most 5 % of a core
//   bench_panel attack   the cycle's steps at 50 Hz without and with 1,000 half-open sockets, slow-loris, a
//                        gigabyte of upload, bad frames and malformed requests, again and again
//   cmake --build build/release --target bench_panel && build/release/tests/bench/bench_panel attack
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>

#include "hmi/server/api.hpp"
#include "hmi/server/scan_frame.hpp"
#include "hmi/server/server.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "tests/support/panel_attacks.hpp"
#include "tests/support/panel_client.hpp"
#include "tests/support/scripted_vehicle.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kPoints = 20'000;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double process_cpu_s() {
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

struct Panel {
  Panel() {
    folder.write("index.html", "<!doctype html>");
    files.emplace(folder.path());
    hmi::ServerOptions options;
    options.port = 0;
    server.emplace(options, context, *files);
  }
  void show(double t) {
    std::vector<Point2<Base>> scan(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double a = 2.0 * kPi * static_cast<double>(i) / kPoints;
      const double r = 8.0 + 3.0 * std::sin(7.0 * a + t);
      scan[i] = {r * std::cos(a), r * std::sin(a)};
    }
    hmi::LiveState live;
    live.state = "driving";
    live.stamp = live.pose.stamp = std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
    live.scan = std::make_shared<const std::string>(hmi::scan_frame(scan, {t, 0.0, 0.1}));
    for (int i = 0; i < 200; ++i) live.path.push_back({0.1 * i, t});
    vehicle.show(std::move(live));
  }

  test::TemporaryFolder folder;
  hmi::Access access{folder.path() / "pins", false, [] { return Clock::now(); }};
  test::ScriptedVehicle vehicle;
  hmi::Job job;
  hmi::Replay replay;
  hmi::SiteEditor editor{folder.path() / "site"};
  hmi::ApiContext context{access, editor, vehicle, job, replay, [] { return std::string(); }, {}};
  std::optional<hmi::StaticFiles> files;
  std::optional<hmi::Server> server;
};

/// Runs `work` again and again in another process, behind this one, until the object goes.
class Other {
 public:
  template <class Work>
  explicit Other(Work work) : child_(::fork()) {
    if (child_ != 0) return;
    (void)::setpriority(PRIO_PROCESS, 0, 10);
    while (true) {
      try {
        work();
      } catch (const std::exception&) {
        // The server has closed the socket, as it should.
      }
    }
  }
  ~Other() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  Other(const Other&) = delete;
  Other& operator=(const Other&) = delete;

 private:
  pid_t child_;
};

void bench_live() {
  Panel panel;
  const unsigned short port = panel.server->port();
  const auto produce = [&](double for_s) {
    const auto begin = Clock::now();
    const double cpu = process_cpu_s();
    for (int i = 0; seconds_since(begin) < for_s; ++i) {
      panel.show(0.1 * i);
      std::this_thread::sleep_until(begin + std::chrono::milliseconds(100) * (i + 1));
    }
    return (process_cpu_s() - cpu) / seconds_since(begin);
  };
  produce(1.0);
  const double alone = produce(10.0);
  const Other browser([port] {
    test::LiveClient client(port, "same");
    while (true) (void)client.receive_binary();
  });
  produce(1.0);
  const double watched = produce(20.0);
  std::printf("packing %zu points at 10 Hz, nobody looks on: %.2f %% of a core\n", kPoints, 100.0 * alone);
  std::printf("with one panel at 10 Hz:                      %.2f %% of a core\n", 100.0 * watched);
}

struct Times {
  std::vector<double> step_ms;
  std::vector<double> late_ms;
};

double share_of(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Recorded inputs through the cycle in real time.
Times run_cycle(const app::CycleConfig& config, const test::ToyVehicle& recorded, Panel& panel) {
  app::CycleState state(config, std::make_unique<test::TruePose>(recorded.rolling));
  Times times;
  auto next = Clock::now();
  for (const auto& input : recorded.inputs) {
    next += std::chrono::milliseconds(20);
    std::this_thread::sleep_until(next);
    times.late_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - next).count());
    const auto begin = Clock::now();
    auto [after, output] = app::step(std::move(state), input, config);
    times.step_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    state = std::move(after);
    if (!input.clouds.empty()) panel.show(to_seconds(input.now));
  }
  return times;
}

void attack(unsigned short port) {
  test::NeglectedSockets half_open(port, 1000, "");
  test::NeglectedSockets slow(port, 100, "GET /api/session HTTP/1.1\r\nX: ");
  for (int round = 0; round < 20; ++round) {
    (void)slow.drip('a');
    for (const auto& frames : test::bad_frames()) (void)test::closes_on_frames(port, frames);
    for (const auto& path : test::climbing_paths())
      (void)test::http_call(port, {"GET", path, "", "", "same", ""});
    (void)test::http_call(port, {"POST", "/api/orders", std::string(100'000, '['), "", "same", ""});
    (void)test::http_call(port, {"POST", "/api/vehicle/start", "{}", "", "http://evil.example", ""});
    (void)test::upload_for_ever(port, 1U << 30U, false);
  }
}

void bench_attack() {
  auto config = test::toy_config(
      planning::parse_routes("ID,EDA\n0,1\n1,0 2\n2,1\n", "ID,x,y\n0,0,0\n1,30,0\n2,30,20\n").graph);
  test::ToyVehicle vehicle(config, {0.0, 0.0, 0.0});
  vehicle.lidar.azimuths = 1800;
  for (double x = 1.0; x < 28.0; x += 1.5)
    for (const double y : {-1.6, 1.9}) vehicle.lidar.posts.push_back({{x, y}, 0.2, 1.8});
  vehicle.record = true;
  vehicle.drive_to({{2}});
  vehicle.say(app::OperatorWord::Resume);
  vehicle.run_until([&] { return vehicle.delivered(); }, 30.0);
  Panel panel;
  const unsigned short port = panel.server->port();
  const auto print = [](const char* what, const Times& t) {
    std::printf("%-15s step median %.3f p99 %.3f most %.3f ms; late p99 %.3f most %.3f ms\n", what,
                share_of(t.step_ms, 0.5), share_of(t.step_ms, 0.99), share_of(t.step_ms, 1.0),
                share_of(t.late_ms, 0.99), share_of(t.late_ms, 1.0));
  };
  for (int repeat = 0; repeat < 3; ++repeat) {
    const Times calm = run_cycle(config, vehicle, panel);
    print("calm", calm);
    const Other attacker([port] { attack(port); });
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const Times attacked = run_cycle(config, vehicle, panel);
    print("under attack", attacked);
    std::printf("p99 of the step, attacked / calm: %.2f\n",
                share_of(attacked.step_ms, 0.99) / share_of(calm.step_ms, 0.99));
  }
  const auto after = test::http_call(port, {"GET", "/api/session", "", "", "same", ""});
  std::printf("the server after it: %d\n", after.status);
}

}  // namespace
}  // namespace madori

int main(int argc, char** argv) {
  const std::string what = argc == 2 ? argv[1] : "";
  if (what == "live")
    madori::bench_live();
  else if (what == "attack")
    madori::bench_attack();
  else
    return 2;
}
