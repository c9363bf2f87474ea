#include "localization/particle_filter/particle_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "localization/particle_filter/motion_kernel.hpp"
#include "localization/particle_filter/sensor_kernel.hpp"

namespace madori::localization {
namespace {

/// Lower factor of a covariance; tiny negative pivots of a singular one count as zero.
Eigen::Matrix3d lower_factor(const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d l = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double pivot = covariance(j, j) - l.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0)) continue;
    l(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < 3; ++i)
      l(i, j) = (covariance(i, j) - l.row(i).head(j).dot(l.row(j).head(j))) / l(j, j);
  }
  return l;
}

MotionStep motion_step(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance, std::uint64_t key) {
  const Eigen::Matrix3f l = lower_factor(covariance).cast<float>();
  MotionStep step;
  for (int i = 0; i < 3; ++i) step.mean[static_cast<std::size_t>(i)] = static_cast<float>(mean[i]);
  step.lower = {l(0, 0), l(1, 0), l(1, 1), l(2, 0), l(2, 1), l(2, 2)};
  step.key1 = static_cast<std::uint32_t>(key);
  step.key2 = static_cast<std::uint32_t>(key >> 32);
  return step;
}

}  // namespace

ParticleFilter::ParticleFilter(const ParticleFilterOptions& options, std::uint64_t seed)
    : options_(options), random_(seed) {}

void ParticleFilter::draw(const Transform2<Map, Base>& pose, const Eigen::Matrix3d& covariance,
                          std::size_t first, std::size_t count) {
  // Seen from the Map's axes at the origin, "moved by N(pose, covariance)" is the draw itself.
  for (auto* array : {&particles_.x_m, &particles_.y_m, &particles_.yaw_rad})
    std::fill_n(array->begin() + static_cast<std::ptrdiff_t>(first), count, 0.0F);
  const Eigen::Vector3d mean(pose.x_m() - particles_.origin.x_m, pose.y_m() - particles_.origin.y_m,
                             pose.yaw_rad());
  move_particles(motion_step(mean, covariance, random_()), particles_.x_m.data() + first,
                 particles_.y_m.data() + first, particles_.yaw_rad.data() + first, count);
}

void ParticleFilter::start_at(const Transform2<Map, Base>& pose, const Eigen::Matrix3d& covariance,
                              std::size_t count) {
  particles_.origin = pose.translation();
  particles_.resize(count);
  std::fill(particles_.weight.begin(), particles_.weight.end(), 1.0F / static_cast<float>(count));
  draw(pose, covariance, 0, count);
}

void ParticleFilter::inject(const Transform2<Map, Base>& pose, const Eigen::Matrix3d& covariance,
                            double share) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(particles_.size()));
  if (count == 0) return;
  std::vector<std::size_t> order(particles_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // The heaviest stay, at the front; the lightest `count` are drawn anew at the back.
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(order.size() - count),
                   order.end(),
                   [&](std::size_t a, std::size_t b) { return particles_.weight[a] > particles_.weight[b]; });
  spare_.origin = particles_.origin;
  spare_.resize(particles_.size());
  double kept = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    spare_.x_m[i] = particles_.x_m[order[i]];
    spare_.y_m[i] = particles_.y_m[order[i]];
    spare_.yaw_rad[i] = particles_.yaw_rad[order[i]];
    spare_.weight[i] = particles_.weight[order[i]];
    if (i < order.size() - count) kept += spare_.weight[i];
  }
  std::swap(particles_, spare_);
  const std::size_t first = particles_.size() - count;
  for (std::size_t i = 0; i < particles_.size(); ++i)
    particles_.weight[i] = i < first ? static_cast<float>(particles_.weight[i] / kept * (1.0 - share))
                                     : static_cast<float>(share / static_cast<double>(count));
  draw(pose, covariance, first, count);
}

void ParticleFilter::predict(const Transform2<Base, Base>& moved, const Eigen::Matrix3d& covariance) {
  move_particles(motion_step({moved.x_m(), moved.y_m(), moved.yaw_rad()}, covariance, random_()),
                 particles_.x_m.data(), particles_.y_m.data(), particles_.yaw_rad.data(), particles_.size());
}

double ParticleFilter::correct(const ScanPoints& points, const LikelihoodField& field,
                               const mapping::DistanceField* walls) {
  const BeamBlocks beams(points, field, options_.most_beams);
  if (beams.beams() == 0 || particles_.size() == 0) return 0.0;
  sums_.resize(particles_.size());
  sum_counts(particles_, beams, field, sums_);
  const double per_count = log_likelihood_per_count(beams, field);
  log_weight_.resize(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    log_weight_[i] = static_cast<float>(per_count * sums_[i]);
    if (walls != nullptr && options_.through_wall_nats > 0.0)
      log_weight_[i] -= static_cast<float>(options_.through_wall_nats * field.model().effective_beams *
                                           share_through_walls(points, *walls, particles_.pose(i)));
  }
  return weigh();
}

double ParticleFilter::weigh() {
  const float most = *std::max_element(log_weight_.begin(), log_weight_.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.weight[i] *= std::exp(log_weight_[i] - most);
    sum += particles_.weight[i];
  }
  const bool usable =
      sum > 0.0 && std::isfinite(sum);  // else every weight was zero: begin again from equal ones
  const auto equal = 1.0F / static_cast<float>(particles_.size());
  for (float& w : particles_.weight) w = usable ? static_cast<float>(w / sum) : equal;
  return usable ? std::log(sum) + most : most;
}

bool ParticleFilter::resample_if_needed() {
  const double size = static_cast<double>(particles_.size());
  if (particles_.size() == 0 || effective_size(particles_) >= options_.resample_below * size) return false;
  const std::size_t wanted = kld_number(bins_.count(particles_, options_.kld), options_.kld);
  std::uniform_real_distribution<double> offset(0.0, 1.0);
  resample(particles_, std::clamp(wanted, options_.min_particles, options_.max_particles), offset(random_),
           spare_);
  std::swap(particles_, spare_);
  return true;
}

ParticleEstimate ParticleFilter::estimate() const {
  ParticleEstimate estimate;
  estimate.effective_size = effective_size(particles_);
  double x = 0.0, y = 0.0, c = 0.0, s = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const double w = particles_.weight[i];
    x += w * particles_.x_m[i];
    y += w * particles_.y_m[i];
    c += w * std::cos(double{particles_.yaw_rad[i]});
    s += w * std::sin(double{particles_.yaw_rad[i]});
  }
  const double yaw = std::atan2(s, c);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Eigen::Vector3d e(particles_.x_m[i] - x, particles_.y_m[i] - y,
                            wrap_angle(particles_.yaw_rad[i] - yaw));
    estimate.covariance += double{particles_.weight[i]} * e * e.transpose();
  }
  estimate.map_from_base = {particles_.origin.x_m + x, particles_.origin.y_m + y, yaw};
  return estimate;
}

}  // namespace madori::localization
