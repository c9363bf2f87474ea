#include "localization/slam/rbpf_mapper.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/particle_filter/motion_kernel.hpp"
#include "localization/particle_filter/resampling.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

MotionStep step_of(const Transform2<Base, Base>& motion, const Eigen::Matrix3d& covariance,
                   std::mt19937& engine) {
  const Eigen::Matrix3d l = covariance.llt().matrixL();
  MotionStep step;
  step.mean = {static_cast<float>(motion.x_m()), static_cast<float>(motion.y_m()),
               static_cast<float>(motion.yaw_rad())};
  step.lower = {static_cast<float>(l(0, 0)), static_cast<float>(l(1, 0)), static_cast<float>(l(1, 1)),
                static_cast<float>(l(2, 0)), static_cast<float>(l(2, 1)), static_cast<float>(l(2, 2))};
  step.key1 = static_cast<std::uint32_t>(engine());
  step.key2 = static_cast<std::uint32_t>(engine());
  return step;
}

}  // namespace

RbpfMapper::RbpfMapper(const RbpfOptions& options)
    : options_(options), follower_(options.front), engine_(options.seed) {
  front_.memory = Memory(options.front.memory);
}

std::size_t RbpfMapper::best() const {
  const auto most = std::max_element(particles_.begin(), particles_.end(),
                                     [](const auto& a, const auto& b) { return a.log_sum < b.log_sum; });
  return static_cast<std::size_t>(most - particles_.begin());
}

std::vector<double> RbpfMapper::weights() const {
  double most = -INFINITY, sum = 0.0;
  for (const Particle& p : particles_) most = std::max(most, p.log_weight);
  std::vector<double> w;
  for (const Particle& p : particles_) w.push_back(std::exp(p.log_weight - most));
  for (const double v : w) sum += v;
  for (double& v : w) v /= sum;
  return w;
}

double RbpfMapper::effective_particles() const {
  double squares = 0.0;
  for (const double w : weights()) squares += w * w;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

PoseEstimate RbpfMapper::estimate(Stamp stamp) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.health.state = is_lost_ ? LocalizationState::Degraded : LocalizationState::Localized;
  if (particles_.empty()) return estimate;
  const std::vector<double> w = weights();
  const Pose here = particles_[best()].way->map_from_base;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const Eigen::Vector3d off = pose_difference(particles_[i].way->map_from_base, here);
    estimate.covariance += w[i] * off * off.transpose();
  }
  const auto since_keyframe = front_.memory.poses().back().inverse() * anchor_;
  estimate.map_from_base = here * since_keyframe * follower_.since_scan().motion;
  estimate.covariance += in_map_axes(follower_.since_scan().covariance, here.yaw_rad());
  return estimate;
}

PoseEstimate RbpfMapper::on_odometry(const OdometryReading& reading) {
  follower_.on_odometry(reading);
  return estimate(reading.stamp);
}

void RbpfMapper::follow(const SurfaceScan& scan) {
  const auto followed = follower_.follow(scan, anchor_, front_);
  is_lost_ = !followed.found;
  anchor_ = anchor_ * followed.motion;
  reckoned_.push_back({scan.stamp, reckoned_.back().odom_from_base * followed.motion});
}

Pose RbpfMapper::sampled(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d z(normal(engine_), normal(engine_), normal(engine_));
  const Eigen::Matrix3d regular = covariance + 1e-10 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d x = mean + Eigen::Matrix3d(regular.llt().matrixL()) * z;
  return {x[0], x[1], x[2]};
}

/// Where K poses around a match lie in the mean, weighed by scan and wheels, how far they spread, and what
/// they are worth together.
RbpfMapper::Proposal RbpfMapper::around(const GridMatch& match, const SurfaceScan& scan,
                                        const SurfaceGrid& map, const PosePrior& prior) const {
  const Pose& m = match.map_from_base;
  std::array<double, 27> log_tau{};
  std::array<Eigen::Vector3d, 27> offs;
  std::size_t n = 0;
  for (const int dx : {-1, 0, 1}) {
    for (const int dy : {-1, 0, 1}) {
      for (const int da : {-1, 0, 1}) {
        offs[n] = {dx * options_.sample_m, dy * options_.sample_m, da * options_.sample_rad};
        const Pose at(m.x_m() + offs[n][0], m.y_m() + offs[n][1], m.yaw_rad() + offs[n][2]);
        log_tau[n++] = log_likelihood(scan, map, at, options_.beams) + prior.log_density(at);
      }
    }
  }
  const double most = *std::max_element(log_tau.begin(), log_tau.end());
  double eta = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) eta += std::exp(log_tau[i] - most);
  for (std::size_t i = 0; i < n; ++i) mean += std::exp(log_tau[i] - most) / eta * offs[i];
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < n; ++i)
    covariance += std::exp(log_tau[i] - most) / eta * (offs[i] - mean) * (offs[i] - mean).transpose();
  // No wider than what scan and motion know together: the steps between the K poses are coarser than that.
  const Eigen::Matrix3d known = match.information.inverse();
  if (known.trace() < covariance.trace()) covariance = known;
  return {Eigen::Vector3d(m.x_m(), m.y_m(), m.yaw_rad()) + mean, covariance,
          most + std::log(eta / static_cast<double>(n))};
}

/// One particle: laid on its own map, from where the scans and from where the wheels put it; where these end
/// apart, one is drawn by what it is worth. Where neither lies on the map, the motion is drawn.
void RbpfMapper::extend(Particle& particle, const SurfaceScan& scan, const Pose& by_scans,
                        const PosePrior& prior, const Pose& drawn) {
  constexpr double kSame = 0.05;  // metres and radians
  std::vector<Proposal> proposals;
  GridMatch first;
  for (const Pose& start : {by_scans, prior.map_from_base}) {
    const GridMatch match = match_to_grid(scan, particle.map, start, prior);
    if (match.inlier_share < options_.least_inliers) continue;
    if (!proposals.empty() && pose_difference(match.map_from_base, first.map_from_base).norm() < kSame)
      continue;
    first = match;
    proposals.push_back(around(match, scan, particle.map, prior));
  }
  Pose pose = drawn;
  double log_eta = 0.0;
  if (proposals.empty()) {
    log_eta = log_likelihood(scan, particle.map, drawn, options_.beams);
  } else {
    std::vector<double> worth;
    for (const Proposal& p : proposals) worth.push_back(std::exp(p.log_eta - proposals.front().log_eta));
    std::discrete_distribution<std::size_t> draw(worth.begin(), worth.end());
    const Proposal& chosen = proposals[draw(engine_)];
    pose = sampled(chosen.mean, chosen.covariance);
    log_eta = std::log(std::accumulate(worth.begin(), worth.end(), 0.0)) + proposals.front().log_eta;
  }
  particle.log_weight += log_eta;
  particle.log_sum += log_eta;
  particle.way = std::make_shared<const Moment>(Moment{pose, particle.way});
  particle.map.add(scan, pose);
}

void RbpfMapper::propose(const SurfaceScan& scan, const MeasuredMotion& motion) {
  const OdometryStep& wheels = follower_.since_keyframe().wheels();
  const Eigen::Matrix3d covariance = with_floor(wheels.covariance);
  Particles drawn;
  drawn.origin = particles_.front().way->map_from_base.translation();
  for (const Particle& p : particles_) drawn.add(p.way->map_from_base);
  move_particles(step_of(motion.motion, covariance, engine_), drawn.x_m.data(), drawn.y_m.data(),
                 drawn.yaw_rad.data(), drawn.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Pose& before = particles_[i].way->map_from_base;
    const PosePrior prior{before * wheels.motion, in_map_axes(covariance, before.yaw_rad()).inverse()};
    extend(particles_[i], scan, before * motion.motion, prior, drawn.pose(i));
  }
}

void RbpfMapper::resample_where_needed() {
  const auto count = particles_.size();
  if (effective_particles() >= options_.resample_below * static_cast<double>(count)) return;
  std::uniform_real_distribution<double> offset(0.0, 1.0);
  std::vector<Particle> next;
  next.reserve(count);
  const std::vector<double> w = weights();
  draw_systematically(w, count, offset(engine_), [&](std::size_t i) { next.push_back(particles_[i]); });
  for (Particle& p : next) p.log_weight = 0.0;
  particles_ = std::move(next);
}

void RbpfMapper::remember(const SurfaceScan& scan) {
  Memory& memory = front_.memory;
  const KeyframeMotion& driven = follower_.since_keyframe();
  const MeasuredMotion motion = memory.empty() ? MeasuredMotion{} : driven.measured(memory.poses().back());
  if (memory.empty()) {
    particles_.resize(std::max<std::size_t>(options_.particles, 1));
    for (Particle& p : particles_) {
      p.way = std::make_shared<const Moment>(Moment{anchor_, nullptr});
      p.map.add(scan, anchor_);
    }
  } else {
    propose(scan, motion);
    resample_where_needed();
  }
  memory.add(scan, driven.path_m(), anchor_, motion);
  follower_.begin_keyframe();
  scan_of_.push_back(reckoned_.size() - 1);
}

PoseEstimate RbpfMapper::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  const LocalizerOptions& front = options_.front;
  SurfaceScanOptions how = front.scan;
  how.noise_m = noise_.after(scan_noise_m(points));
  const SurfaceScan scan = make_surface_scan(stamp, sensor, weighty_points(points), how);
  const Memory& memory = front_.memory;
  if (memory.empty()) {
    if (scan.points.empty()) return estimate(stamp);
    reckoned_.push_back({stamp, {}});
    remember(scan);
  } else {
    follow(scan);
    if (is_new_view(memory.poses().back().inverse() * anchor_, front)) remember(scan);
  }
  follower_.note_scan(stamp);
  return estimate(stamp);
}

/// The way of the particle that explains all of the drive best.
FinishedMap RbpfMapper::finish() {
  FinishedMap finished;
  if (particles_.empty()) return finished;
  std::vector<Pose> poses;
  for (const Moment* m = particles_[best()].way.get(); m != nullptr; m = m->before.get())
    poses.push_back(m->map_from_base);
  std::reverse(poses.begin(), poses.end());
  std::vector<WayAnchor> anchors;
  for (std::size_t k = 0; k < scan_of_.size(); ++k) anchors.push_back({scan_of_[k], poses[k]});
  finished.scans = laid_way(reckoned_, anchors);
  finished.memory =
      Memory(options_.front.memory, front_.memory.keyframes(), std::move(poses), front_.memory.factors(), 0);
  return finished;
}

}  // namespace madori::localization
