// Serves the built panel for a site folder with a vehicle that drives in circles: for looking at pages
// without a vehicle. Usage: panel_host SITE_FOLDER DIST_FOLDER PORT
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "core/clock.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/scan_frame.hpp"
#include "hmi/server/server.hpp"
#include "tests/support/scripted_vehicle.hpp"

int main(int argc, char** argv) {
  using namespace madori;
  if (argc != 4) return 2;
  hmi::Access access(std::filesystem::path(argv[1]) / "pins", false,
                     [] { return std::chrono::steady_clock::now(); });
  test::ScriptedVehicle vehicle;
  hmi::Job job;
  hmi::Replay replay;
  hmi::StaticFiles files(argv[2]);
  hmi::SiteEditor editor(argv[1]);
  hmi::ApiContext context{
      access, editor, vehicle, job, replay, [] { return std::string("2026-01-01T00:00:00Z"); }, {}, {}};
  hmi::ServerOptions options;
  options.port = static_cast<std::uint16_t>(std::atoi(argv[3]));
  const hmi::Server server(options, context, files);
  std::printf("http://127.0.0.1:%d\n", server.port());
  std::fflush(stdout);
  for (int tick = 0;; ++tick) {
    hmi::LiveState live;
    const double t = 0.1 * tick;
    live.stamp = live.pose.stamp = clock_now();
    live.since = live.stamp - std::chrono::seconds(tick / 10);
    live.state = tick / 100 % 2 == 0 ? "driving" : "waiting";
    if (live.state == "waiting") {
      live.cause = {"obstacle", {}, "Something stands on the route 2.1 m ahead."};
      live.remedy = {"obstacle", {}, "Clear the way; the vehicle goes on by itself."};
    }
    live.goal = "Press 1";
    live.pose.map_from_base = {45.0 + 5.0 * std::cos(0.05 * t), 35.0 + 5.0 * std::sin(0.05 * t),
                               0.05 * t + kPi / 2};
    live.pose.covariance = Eigen::Vector3d(4e-4, 1e-4, 1e-5).asDiagonal();
    live.pose.health = {LocalizationState::Localized, ""};
    live.velocity = {0.25, 0.05};
    live.battery_v = 25.3;
    live.drivable = true;
    std::vector<Point2<Base>> scan;
    for (int i = 0; i < 20000; ++i) {
      const double a = 2 * kPi * i / 20000, r = 6.0 + 2.0 * std::sin(9 * a);
      scan.push_back({r * std::cos(a), r * std::sin(a)});
    }
    live.scan = std::make_shared<const std::string>(hmi::scan_frame(scan, live.pose.map_from_base));
    for (int i = 0; i < 40; ++i)
      live.path.push_back({45.0 + 5.0 * std::cos(0.05 * (t + i)), 35.0 + 5.0 * std::sin(0.05 * (t + i))});
    live.devices = {{"roof lidar", "vlp16", "VLP-16", true, 0.04, 10.0, {}},
                    {"drive", "drive", "", true, 0.01, 50.0, {}}};
    vehicle.show(std::move(live));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}
