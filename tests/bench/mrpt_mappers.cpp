#include "tests/bench/mrpt_mappers.hpp"

#include <mrpt/config/CConfigFile.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include <cmath>
#include <optional>

namespace madori::bench {
namespace {

const std::string kSettings = "/usr/share/mrpt/config_files/";

/// Past 1970, or it counts as none.
mrpt::Clock::time_point stamp_of(const LaserScan& scan) {
  return mrpt::Clock::fromDouble(1e9 + to_seconds(scan.stamp.time_since_epoch()));
}

mrpt::obs::CObservation2DRangeScan::Ptr observation(const LaserScan& scan) {
  auto o = mrpt::obs::CObservation2DRangeScan::Create();
  o->timestamp = stamp_of(scan);
  const std::size_t n = scan.ranges_m.size();
  o->aperture = static_cast<float>(scan.angle_step_rad * static_cast<double>(n - 1));
  o->rightToLeft = true;
  o->maxRange = static_cast<float>(scan.range_max_m);
  o->sensorPose = mrpt::poses::CPose3D(
      0.0, 0.0, 0.0, scan.angle_min_rad + 0.5 * scan.angle_step_rad * static_cast<double>(n - 1), 0.0, 0.0);
  o->resizeScan(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_return = std::isfinite(scan.ranges_m[i]) && scan.ranges_m[i] < scan.range_max_m;
    o->setScanRange(i, is_return ? scan.ranges_m[i] : o->maxRange);
    o->setScanRangeValidity(i, is_return);
  }
  return o;
}

/// What both need: the motion between scans, as an action.
class Builder : public PeerMapper {
 public:
  void on_odometry(const OdometryReading& reading) override { odom_ = reading.odom_from_base; }
  void on_scan(const LaserScan& scan) override {
    const Transform2<Base, Base> moved = at_scan_ ? at_scan_->inverse() * odom_ : Transform2<Base, Base>();
    at_scan_ = odom_;
    mrpt::obs::CActionRobotMovement2D motion;
    motion.computeFromOdometry(mrpt::poses::CPose2D(moved.x_m(), moved.y_m(), moved.yaw_rad()), {});
    motion.timestamp = stamp_of(scan);
    mrpt::obs::CActionCollection actions;
    actions.insert(motion);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation(scan));
    process(actions, frame);
  }

 protected:
  virtual void process(mrpt::obs::CActionCollection& actions, mrpt::obs::CSensoryFrame& frame) = 0;

 private:
  Transform2<Odom, Base> odom_;
  std::optional<Transform2<Odom, Base>> at_scan_;
};

class IcpSlam final : public Builder {
 public:
  IcpSlam() {
    const mrpt::config::CConfigFile file(kSettings + "icp-slam/icp-slam_demo_classic.ini");
    builder_.setVerbosityLevel(mrpt::system::LVL_ERROR);
    builder_.ICP_options.loadFromConfigFile(file, "MappingApplication");
    builder_.ICP_params.loadFromConfigFile(file, "ICP");
    builder_.initialize();
  }
  std::vector<Transform2<Map, Base>> way() override { return way_; }

 private:
  void process(mrpt::obs::CActionCollection& actions, mrpt::obs::CSensoryFrame& frame) override {
    builder_.processActionObservation(actions, frame);
    const auto pose = builder_.getCurrentPoseEstimation()->getMeanVal();
    way_.emplace_back(pose.x(), pose.y(), pose.yaw());
  }
  mrpt::slam::CMetricMapBuilderICP builder_;
  std::vector<Transform2<Map, Base>> way_;
};

mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions rbpf_settings() {
  const mrpt::config::CConfigFile file(kSettings + "rbpf-slam/gridmapping_RBPF_ICPbased_intel.ini");
  mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions options;
  options.loadFromConfigFile(file, "MappingApplication");
  options.verbosity_level = mrpt::system::LVL_ERROR;
  return options;
}

/// The filter has a pose only where it was updated; the scans between lie on the wheels' word from there.
class RbpfSlam final : public Builder {
 public:
  RbpfSlam() : builder_(rbpf_settings()) {
    mrpt::random::getRandomGenerator().randomize(1);
    builder_.setVerbosityLevel(mrpt::system::LVL_ERROR);
    builder_.initialize();
  }
  std::vector<Transform2<Map, Base>> way() override {
    std::deque<mrpt::math::TPose3D> path;
    builder_.getCurrentMostLikelyPath(path);
    std::vector<Transform2<Map, Base>> way;
    for (const auto& [updates, since] : scans_) {
      const std::size_t i = std::min(std::max<std::size_t>(updates, 1), path.size()) - 1;
      way.push_back(Transform2<Map, Base>(path[i].x, path[i].y, path[i].yaw) * since);
    }
    return way;
  }

 private:
  void process(mrpt::obs::CActionCollection& actions, mrpt::obs::CSensoryFrame& frame) override {
    builder_.processActionObservation(actions, frame);
    std::deque<mrpt::math::TPose3D> path;
    builder_.getCurrentMostLikelyPath(path);
    const auto moved = actions.getBestMovementEstimation()->poseChange->getMeanVal();
    const Transform2<Base, Base> step(moved.x(), moved.y(), moved.phi());
    since_ = path.size() == updates_ ? since_ * step : Transform2<Base, Base>();
    updates_ = path.size();
    scans_.emplace_back(updates_, since_);
  }
  mrpt::slam::CMetricMapBuilderRBPF builder_;
  std::size_t updates_ = 0;
  Transform2<Base, Base> since_;
  std::vector<std::pair<std::size_t, Transform2<Base, Base>>> scans_;
};

}  // namespace

std::unique_ptr<PeerMapper> peer_mapper(const std::string& name) {
  if (name == "rbpf-slam") return std::make_unique<RbpfSlam>();
  return std::make_unique<IcpSlam>();
}

}  // namespace madori::bench
