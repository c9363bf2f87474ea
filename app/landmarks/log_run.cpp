#include "app/landmarks/log_run.hpp"

#include <algorithm>
#include <cmath>

#include "app/log_player.hpp"
#include "core/result.hpp"
#include "localization/landmarks/dead_reckoning.hpp"

namespace madori::app {
namespace {

namespace lm = localization::landmarks;

template <class To, class From>
Transform2<To, From> transform(const lm::Displacement& d) {
  return {d.x_m, d.y_m, d.yaw_rad};
}

}  // namespace

void AgentTrack::add(Stamp stamp, const Transform2<Odom, Base>& odom_from_base) {
  double path_m = 0.0;
  if (!records_.empty())
    path_m = records_.back().path_m +
             distance_m(records_.back().odom_from_base.translation(), odom_from_base.translation());
  records_.push_back({stamp, odom_from_base, path_m});
}

AgentTrack::AgentTrack(sensors::LogReader& log, lm::LandmarkHub& hub, bool match_scans,
                       const std::optional<lm::FullPose>& rough_start) {
  lm::LandmarkAgent agent(hub, rough_start);
  lm::DeadReckoning reckoning(match_scans);
  bool any_scan = false;
  while (const auto record = log.next()) {
    if (const auto* odometry = std::get_if<OdometryReading>(&*record)) {
      add(odometry->stamp, reckoning.on_odometry(*odometry));
      continue;
    }
    const auto* scan = std::get_if<sensors::ScanRecord>(&*record);
    if (scan == nullptr) continue;  // a 3D lidar sees no corridor walls at its own height alone
    any_scan = true;
    const Stamp stamp = scan->scan.stamp;
    if (scan->odom_from_base) (void)reckoning.on_odometry({stamp, *scan->odom_from_base});
    const localization::ScanPoints points = points_of(*scan);
    add(stamp, reckoning.on_scan(stamp, points, scan->base_from_lidar.translation()));
    agent.move(reckoning.take_motion());
    if (const auto sighting = agent.look(stamp, lm::look_around(points))) {
      sightings_.push_back(*sighting);
      at_.push_back(records_.size() - 1);
    }
  }
  if (!any_scan) throw Error("the log", "it holds no 2D scan", "landmarks need a 2D lidar");
}

int AgentTrack::recognised() const {
  return static_cast<int>(
      std::count_if(sightings_.begin(), sightings_.end(), [](const auto& s) { return s.known; }));
}

std::vector<StampedPose> AgentTrack::trajectory(const lm::LandmarkHub& hub,
                                                const Transform2<Map, Map>& map_from_origin) const {
  std::vector<StampedPose> out;
  if (sightings_.empty()) return out;
  const auto place = [&](std::size_t i) {
    const lm::Sighting& s = sightings_[i];
    return map_from_origin *
           transform<Map, Base>((hub.landmark(s.landmark).motion * s.landmark_from_agent.motion));
  };
  std::size_t next = 0;  // sighting that the record lies before
  for (std::size_t i = 0; i < records_.size(); ++i) {
    while (next < at_.size() && at_[next] < i) ++next;
    const std::size_t from = next == 0 ? 0 : next - 1;
    const Record& a = records_[at_[from]];
    const Transform2<Map, Base> start = place(from);
    Transform2<Base, Base> way = a.odom_from_base.inverse() * records_[i].odom_from_base;
    if (next > 0 && next < at_.size()) {
      const Record& b = records_[at_[next]];
      const Transform2<Base, Base> measured = a.odom_from_base.inverse() * b.odom_from_base;
      const Transform2<Base, Base> solved = start.inverse() * place(next);
      const double share =
          b.path_m > a.path_m ? (records_[i].path_m - a.path_m) / (b.path_m - a.path_m) : 0.0;
      way = {way.x_m() + share * (solved.x_m() - measured.x_m()),
             way.y_m() + share * (solved.y_m() - measured.y_m()),
             way.yaw_rad() + share * wrap_angle(solved.yaw_rad() - measured.yaw_rad())};
    }
    out.push_back({records_[i].stamp, start * way});
  }
  return out;
}

}  // namespace madori::app
