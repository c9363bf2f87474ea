// From packet to pose: VLP-16 at 10 Hz in the sample factory, 30 % of the walls hidden. What the vehicle
// would receive is made first (all 16 lasers, wheels that slip), then the bytes are played, and the work of
// each revolution is timed: all of its packets decoded and assembled, moved to the last firing, walls
// extracted, and a pose made of them by the Localizer. Processor time of this thread (what a core of one's
// own would take) and time by the clock. The Localizer thinks in a thread beside, which is not counted in
// the first. A load is no measurement: prefer the first figure on a busy machine.
//   bench_cycle [seconds of driving, default 60]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <variant>
#include <vector>

#include "control/diff_drive/odometry.hpp"
#include "localization/localizer/localizer.hpp"
#include "sensors/vlp16/encode.hpp"
#include "simulation/lidar/vlp16_model.hpp"
#include "tests/support/cloud_in_base.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/localization_trial.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;
using Pose = Transform2<Map, Base>;

struct Packet {
  Stamp stamp{};
  std::array<std::uint8_t, sensors::vlp16::kDataBytes> bytes{};
};
using Event = std::variant<OdometryReading, Packet>;

struct Drive {
  std::vector<Event> events;
  Pose start;
  mapping::SensorRecord lidar;
  mapping::Walls walls;
  std::vector<std::pair<Stamp, Pose>> truth;
};

/// Drives the sample factory for some seconds and keeps what reached the vehicle.
Drive recorded_drive(double seconds) {
  const test::TrialSetup setup = test::sample_factory_trial(MADORI_DATA_DIR, 30.0, 0);
  test::VirtualFloor floor(setup.walls, setup.scenario, 1);
  test::TrueDriver driver(setup.routes, 1);
  simulation::Vlp16Model vlp16(floor.lidar(), setup.scenario.vlp16, 1, Duration(0));
  const mapping::VehicleRecord vehicle;
  control::DiffDriveOdometry odometry(control::OdometryOptions{
      {vehicle.wheel_radius_m, vehicle.wheel_radius_m, vehicle.half_wheel_separation_m}});
  simulation::PoseTrack track;
  const Stamp epoch = floor.now();
  track.add(Duration(0), floor.world().frames().building_pose(floor.truth()));
  Drive drive{{}, floor.truth(), floor.lidar(), setup.drawing, {}};
  while (to_seconds(floor.now() - epoch) < seconds) {
    const test::FloorInput input = floor.step(driver.command(floor));
    track.add(input.now - epoch, floor.world().frames().building_pose(floor.truth()));
    drive.truth.emplace_back(input.now, floor.truth());
    for (const auto& status : input.drive) {
      odometry.update(status,
                      input.now - std::chrono::microseconds(input.drive.back().time_us - status.time_us));
      drive.events.emplace_back(odometry.reading());
    }
    while (vlp16.next_complete() <= input.now - epoch) {
      const Stamp due = epoch + vlp16.next_complete();
      drive.events.emplace_back(
          Packet{due, sensors::vlp16::encode(vlp16.measure({floor.world(), track, {}}))});
    }
  }
  return drive;
}

double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Times {
  std::vector<double> processor_ms, clock_ms, error_m;
  double points = 0.0;
};

Point2<Map> truth_at(const Drive& drive, Stamp stamp) {
  const auto after = std::lower_bound(drive.truth.begin(), drive.truth.end(), stamp,
                                      [](const auto& entry, Stamp s) { return entry.first < s; });
  if (after == drive.truth.begin() || after == drive.truth.end()) return drive.start.translation();
  const auto before = std::prev(after);
  const double share = to_seconds(stamp - before->first) / to_seconds(after->first - before->first);
  const Point2<Map> a = before->second.translation(), b = after->second.translation();
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
}

Times play(const Drive& drive) {
  Localizer localizer(drive.walls, InitialPose{drive.start});
  Times times;
  OdometryTrack track;
  std::vector<PointCloud<Lidar>> clouds;
  sensors::vlp16::Assembler assembler(
      [&](sensors::vlp16::Frame& f) { clouds.push_back(std::move(f.cloud)); });
  const auto& at = drive.lidar;
  const LidarModel lidar = test::spinning_lidar({at.x_m, at.y_m, at.z_m, to_rad(at.yaw_deg)});
  double processor = 0.0, clock = 0.0;
  for (const Event& event : drive.events) {
    const double processor0 = seconds_of(CLOCK_THREAD_CPUTIME_ID), clock0 = seconds_of(CLOCK_MONOTONIC);
    std::optional<Pose> pose;
    Stamp stamp{};
    if (const auto* reading = std::get_if<OdometryReading>(&event)) {
      (void)track.add(*reading);
      (void)localizer.on_odometry(*reading);
    } else {
      const Packet& packet = std::get<Packet>(event);
      (void)assembler.push(packet.bytes, packet.stamp);
      for (const auto& cloud : clouds) {
        const PointCloud<Base> base = test::cloud_in_base(cloud, lidar, track);
        const ScanPoints walls = extract_walls(base, lidar);
        times.points += static_cast<double>(walls.size());
        pose = localizer.on_scan(stamp = base.stamp, walls).map_from_base;
      }
      clouds.clear();
    }
    processor += seconds_of(CLOCK_THREAD_CPUTIME_ID) - processor0;
    clock += seconds_of(CLOCK_MONOTONIC) - clock0;
    if (!pose) continue;
    times.processor_ms.push_back(1e3 * std::exchange(processor, 0.0));
    times.clock_ms.push_back(1e3 * std::exchange(clock, 0.0));
    times.error_m.push_back(distance_m(truth_at(drive, stamp), pose->translation()));
  }
  return times;
}

double at_share(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

void run(double seconds) {
  const Times t = play(recorded_drive(seconds));
  std::printf(
      "%zu revolutions of %.0f wall points: processor median %.2f ms, p99 %.2f, most %.2f; by the clock "
      "median %.2f, p99 %.2f; error median %.3f m, most %.3f\n",
      t.clock_ms.size(), t.points / static_cast<double>(t.clock_ms.size()), at_share(t.processor_ms, 0.5),
      at_share(t.processor_ms, 0.99), at_share(t.processor_ms, 1.0), at_share(t.clock_ms, 0.5),
      at_share(t.clock_ms, 0.99), at_share(t.error_m, 0.5), at_share(t.error_m, 1.0));
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  madori::bench::run(argc > 1 ? std::atof(argv[1]) : 60.0);
  return 0;
}
