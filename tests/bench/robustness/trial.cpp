#include "tests/bench/robustness/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/log_player.hpp"
#include "localization/localizer/localizer.hpp"
#include "tests/support/lidar_models.hpp"

namespace madori::bench {
namespace {

using app::StampedPose;

/// A log that vanishes record by record.
class Replay final : public sensors::LogReader {
 public:
  explicit Replay(Records records) : records_(std::move(records)) {}
  std::optional<sensors::LogRecord> next() override {
    if (at_ == records_.size()) return std::nullopt;
    return records_[at_++];
  }

 private:
  Records records_;
  std::size_t at_ = 0;
};

const StampedPose& nearest(const Truth& truth, Stamp stamp) {
  return *std::min_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
    return std::abs((a.stamp - stamp).count()) < std::abs((b.stamp - stamp).count());
  });
}

/// The pose at a scan, and what it was judged by.
struct AtScan {
  PoseEstimate estimate;
  localization::HealthEvidence evidence;
};

std::string csv_line(const AtScan& at, const StampedPose& t) {
  const auto& [e, evidence] = at;
  const Transform2<Base, Base> off = t.map_from_base.inverse() * e.map_from_base;
  return fmt::format(
      "{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.3f},{:.3f},{:.3f},{:.2f},{:.3f},{:.4f},{:.4f},{},\"{}"
      "\"\n",
      to_seconds(t.stamp.time_since_epoch()), t.map_from_base.x_m(), t.map_from_base.y_m(),
      e.map_from_base.x_m() - t.map_from_base.x_m(), e.map_from_base.y_m() - t.map_from_base.y_m(),
      to_deg(off.yaw_rad()), evidence.on_walls, evidence.on_memory,
      std::sqrt(e.covariance.topLeftCorner<2, 2>().trace()), evidence.nats_a_wall, evidence.sigma_m,
      evidence.here, evidence.rival, to_string(e.health.state), e.health.reason);
}

void judge_scans(const std::vector<AtScan>& at_scans, const Truth& truth, Outcome& out) {
  int run = 0;
  for (const AtScan& at : at_scans) {
    const PoseEstimate& e = at.estimate;
    const StampedPose& t = nearest(truth, e.stamp);
    if (std::abs(to_seconds(t.stamp - e.stamp)) > 0.05) continue;
    out.scans += csv_line(at, t);
    const double d = distance_m(t.map_from_base.translation(), e.map_from_base.translation());
    run = d > 2.0 ? run + 1 : 0;
    out.longest_lost = std::max(out.longest_lost, run);
    const bool sure = e.health.state == LocalizationState::Localized;
    out.wrongly_sure += d > 1.5 && sure ? 1 : 0;
    out.worst_sure_m = std::max(out.worst_sure_m, sure ? d : 0.0);
  }
}

std::vector<Stamp> scan_stamps(const Records& log) {
  std::vector<Stamp> stamps;
  for (const auto& r : log) {
    if (std::holds_alternative<sensors::ScanRecord>(r)) stamps.push_back(sensors::stamp_of(r));
  }
  return stamps;
}

/// The true pose at the first scan, put off as the case says.
Transform2<Map, Base> start_of(const Truth& truth, Stamp first_scan, const Case& c) {
  const Transform2<Map, Base> begin = nearest(truth, first_scan).map_from_base;
  return {begin.x_m() + c.start_x_m, begin.y_m() + c.start_y_m, begin.yaw_rad() + to_rad(c.start_deg)};
}

}  // namespace

Truth truth_of(const Building& building, const Case& c) {
  Truth truth = building.truth;
  const Stamp first = sensors::stamp_of(building.log.front());
  const Stamp last = sensors::stamp_of(building.log.back());
  for (StampedPose& pose : truth) {
    if (c.log.reversed) pose.stamp = first + (last - pose.stamp);
    const Point2<Map> p = scaled_about_middle(building.walls, pose.map_from_base.translation(), c.lies.scale);
    pose.map_from_base = {p.x_m, p.y_m, pose.map_from_base.yaw_rad()};
  }
  return truth;
}

Outcome play(const Building& building, const Case& c, localization::Memory& memory) {
  std::mt19937 engine(c.seed);
  const mapping::Walls walls = c.has_drawing ? lie(building.walls, c.lies, engine) : mapping::Walls{};
  const Records log = harmed(building.log, c.log, engine);
  const Truth truth = truth_of(building, c);
  const std::vector<Stamp> stamps = scan_stamps(log);
  localization::Localizer localizer(walls, localization::InitialPose{start_of(truth, stamps.front(), c)},
                                    c.options);
  if (!memory.empty()) localizer.recall(std::move(memory));
  Outcome out;
  std::vector<AtScan> at_scans;
  Replay reader(log);
  std::size_t scan = 0;
  app::PlayedLog played =
      app::play_log(reader, test::planar_lidar({0.0, 0.0, 0.3, 0.0}), localizer, [&](const PoseEstimate& e) {
        out.trajectory.push_back({e.stamp, e.map_from_base});
        out.health.add(e);
        if (scan < stamps.size() && e.stamp == stamps[scan]) {
          at_scans.push_back({e, localizer.evidence()});
          ++scan;
        }
      });
  std::sort(played.scan_ms.begin(), played.scan_ms.end());
  out.p50_ms = played.scan_ms[played.scan_ms.size() / 2];
  out.p99_ms = played.scan_ms[played.scan_ms.size() * 99 / 100];
  judge_scans(at_scans, truth, out);
  memory = localizer.finished_memory();
  return out;
}

}  // namespace madori::bench
