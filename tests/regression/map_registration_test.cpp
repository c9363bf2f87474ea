// Maps laid on maps, and scans on maps, from 0.5 m and 10 degrees off: forty a recorded building. The truth
// is the log's reference, good to about 0.06 m and, on Intel, 2.5 degrees by the measured relations.
#include "localization/ndt_map/map_registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "app/trajectory_file.hpp"
#include "localization/ndt_map/hybrid_map.hpp"
#include "sensors/carmen/reader.hpp"

namespace madori::app {
namespace {

using namespace localization;

struct PosedScan {
  Stamp stamp{};
  ScanPoints points;
  Point2<Base> sensor;
  Transform2<Map, Base> pose;
};

/// The scans of a log that have a reference pose.
std::vector<PosedScan> posed_scans(const std::filesystem::path& folder, const std::string& name) {
  const std::vector<StampedPose> reference = load_tum(folder / "reference.tum");
  sensors::carmen::CarmenReader log(folder / (name + ".log"));
  std::vector<PosedScan> scans;
  std::size_t next = 0;
  while (const auto record = log.next()) {
    const auto* scan = std::get_if<sensors::ScanRecord>(&*record);
    if (scan == nullptr) continue;
    const auto off_s = [&](std::size_t i) {
      return std::abs(to_seconds(reference[i].stamp - scan->scan.stamp));
    };
    while (next + 1 < reference.size() && off_s(next + 1) <= off_s(next)) ++next;
    if (off_s(next) > 0.02) continue;
    scans.push_back({scan->scan.stamp, scan_points(scan->scan, scan->base_from_lidar),
                     scan->base_from_lidar.translation(), reference[next].map_from_base});
  }
  return scans;
}

void look(HybridMap& map, const PosedScan& scan, const Transform2<Map, Map>& moved) {
  map.look(beams_of(scan.points, scan.sensor, 0.3), moved * scan.pose, scan.stamp);
}

struct Trials {
  int trials = 0, maps_right = 0, scans_right = 0;
  std::string wrong;
};

/// Forty pieces of the log, `length` scans each, on the map of all other scans.
Trials try_forty(const std::vector<PosedScan>& scans, std::size_t length) {
  constexpr std::size_t kTrials = 40;
  const auto begin_of = [&](std::size_t k) {
    return (2 * k + 1) * scans.size() / (2 * kTrials) - length / 2;
  };
  HybridMap map;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::size_t k = std::min(i * kTrials / scans.size(), kTrials - 1);
    const bool in_piece = i >= begin_of(k) && i < begin_of(k) + length;
    if (!in_piece) look(map, scans[i], {});
  }
  const GaussianPyramid target(map);
  Trials t;
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  for (std::size_t k = 0; k < kTrials; ++k) {
    const PosedScan& first = scans[begin_of(k)];
    const Transform2<Map, Map> truth(first.pose.x_m(), first.pose.y_m(), first.pose.yaw_rad());
    HybridMap piece;
    for (std::size_t i = 0; i < length; ++i) look(piece, scans[begin_of(k) + i], truth.inverse());
    const double way = turn(engine);
    const Transform2<Map, Map> guess(truth.x_m() + 0.5 * std::cos(way), truth.y_m() + 0.5 * std::sin(way),
                                     truth.yaw_rad() + to_rad(k % 2 == 0 ? 10.0 : -10.0));
    const auto is_right = [&](const char* what, const GaussianPyramid& source) {
      const MapRegistration found = lay_on(target, source, guess);
      const double off_m = std::hypot(found.x_m - truth.x_m(), found.y_m - truth.y_m());
      const double off_deg = to_deg(std::abs(wrap_angle(found.yaw_rad - truth.yaw_rad())));
      const bool right = off_m < 0.2 && off_deg < 3.0;
      if (!right)
        t.wrong += std::string(what) + " " + std::to_string(k) + ": " + std::to_string(off_m) + " m, " +
                   std::to_string(off_deg) + " deg, score " + std::to_string(found.score) +
                   ", at the truth " + std::to_string(lay_on(target, source, truth).score) + "\n";
      return right;
    };
    ++t.trials;
    t.maps_right += is_right("map", GaussianPyramid(piece)) ? 1 : 0;
    t.scans_right += is_right("scan", GaussianPyramid(first.points, 0.25)) ? 1 : 0;
  }
  return t;
}

struct Log {
  const char* name;
  std::size_t length;  ///< of a piece, scans
};

class MapRegistrationOnLogs : public testing::TestWithParam<Log> {};

TEST_P(MapRegistrationOnLogs, IsRightFromHalfAMetreAndTenDegrees) {
  const auto folder = std::filesystem::path(MADORI_SHARED_DATA) / "lidar2d" / GetParam().name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no log at " << folder;
  const Trials t = try_forty(posed_scans(folder, GetParam().name), GetParam().length);
  std::printf("%s: maps %d, scans %d of %d\n%s", GetParam().name, t.maps_right, t.scans_right, t.trials,
              t.wrong.c_str());
  EXPECT_EQ(t.maps_right, t.trials) << t.wrong;
  EXPECT_GE(t.scans_right, t.trials - 1) << t.wrong;
}

INSTANTIATE_TEST_SUITE_P(Logs, MapRegistrationOnLogs,
                         testing::Values(Log{"intel", 6}, Log{"fr079", 40}, Log{"aces", 4}),
                         [](const auto& log) { return std::string(log.param.name); });

}  // namespace
}  // namespace madori::app
