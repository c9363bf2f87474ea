#include "app/mapping_run.hpp"

#include <algorithm>
#include <chrono>

#include "app/trajectory_file.hpp"
#include "localization/slam/laid_way.hpp"

namespace madori::app {
namespace {

using localization::MomentPose;
using localization::ReckonedPose;

/// Where the wheels say the vehicle is at `stamp`, between two readings; clipped to what they know.
Transform2<Odom, Base> wheels_at(const std::vector<ReckonedPose>& wheels, Stamp stamp) {
  if (wheels.empty()) return {};
  const auto after = std::lower_bound(wheels.begin(), wheels.end(), stamp,
                                      [](const ReckonedPose& r, Stamp s) { return r.stamp < s; });
  if (after == wheels.end()) return wheels.back().odom_from_base;
  if (after == wheels.begin() || after->stamp == stamp) return after->odom_from_base;
  const auto before = std::prev(after);
  const double f = to_seconds(stamp - before->stamp) / to_seconds(after->stamp - before->stamp);
  const Transform2<Base, Base> step = before->odom_from_base.inverse() * after->odom_from_base;
  return before->odom_from_base * Transform2<Base, Base>(f * step.x_m(), f * step.y_m(), f * step.yaw_rad());
}

bool carried_between(const localization::FinishedMap& map, Stamp after, Stamp until) {
  return std::any_of(map.carried.begin(), map.carried.end(),
                     [&](Stamp s) { return after < s && s <= until; });
}

/// The scans' poses, and the wheels' way between them laid on these; no way between scans where the vehicle
/// was carried from the one to the other.
std::vector<MomentPose> with_wheels(const localization::FinishedMap& map,
                                    const std::vector<ReckonedPose>& wheels) {
  const auto by_stamp = [](const auto& a, const auto& b) { return a.stamp < b.stamp; };
  std::vector<MomentPose> scans = map.scans;
  std::stable_sort(scans.begin(), scans.end(), by_stamp);
  std::vector<MomentPose> all;
  std::vector<ReckonedPose> way;
  std::vector<localization::WayAnchor> anchors;
  auto next = wheels.begin();
  const auto lay = [&] {
    const auto laid = localization::laid_way(way, anchors);
    all.insert(all.end(), laid.begin(), laid.end());
    way.clear();
    anchors.clear();
  };
  for (const MomentPose& scan : scans) {
    if (carried_between(map, anchors.empty() ? Stamp::min() : way.back().stamp, scan.stamp)) {
      lay();
      while (next != wheels.end() && next->stamp < scan.stamp) ++next;
    }
    for (; next != wheels.end() && next->stamp <= scan.stamp; ++next) way.push_back(*next);
    anchors.push_back({way.size(), scan.map_from_base});
    way.push_back({scan.stamp, wheels_at(wheels, scan.stamp)});
  }
  // Where it was carried after the last scan in the map, the wheels do not say when.
  if (!way.empty() && !carried_between(map, way.back().stamp, Stamp::max()))
    way.insert(way.end(), next, wheels.end());
  lay();
  return all;
}

}  // namespace

MappingRun run_mapper(sensors::LogReader& log, const LogLidars& lidars, localization::Mapper& mapper) {
  MappingRun run;
  std::vector<ReckonedPose> wheels;
  const PoseMaker maker{
      [&](const OdometryReading& reading) {
        if (reading.odom_from_base.is_finite() && (wheels.empty() || wheels.back().stamp <= reading.stamp))
          wheels.push_back({reading.stamp, reading.odom_from_base});
        return mapper.on_odometry(reading);
      },
      [&](Stamp stamp, const localization::ScanPoints& points, const Point2<Base>& sensor) {
        return mapper.on_scan(stamp, points, sensor);
      }};
  run.played = play_log(log, lidars, maker, [&](const PoseEstimate& e) { run.causal.push_back(e); });
  const auto before = std::chrono::steady_clock::now();
  run.map = mapper.finish();
  run.finish_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  run.at_last = with_wheels(run.map, wheels);
  return run;
}

std::string tum_text(const std::vector<PoseEstimate>& poses, const Transform2<Map, Map>& by) {
  std::string text = kTumHead;
  for (const PoseEstimate& pose : poses) text += tum_line(pose.stamp, by * pose.map_from_base);
  return text;
}

std::string tum_text(const std::vector<MomentPose>& poses, const Transform2<Map, Map>& by) {
  std::string text = kTumHead;
  for (const MomentPose& pose : poses) text += tum_line(pose.stamp, by * pose.map_from_base);
  return text;
}

}  // namespace madori::app
