#include "localization/drawing_fit/drawing_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "localization/drawing_fit/wall_hits.hpp"

namespace madori::localization {
namespace {

/// How many walls of two metres were seen around a place.
class Neighbourhoods {
 public:
  Neighbourhoods(const MemoryCloud& cloud, double range_m) : range_m_(range_m) {
    for (const CloudSurface& p : cloud) walls_[cell_of(p)] += p.weight * kShareOfObservation;
  }
  [[nodiscard]] double walls_at(const CloudSurface& p) const { return walls_.at(cell_of(p)); }

 private:
  [[nodiscard]] std::pair<int, int> cell_of(const CloudSurface& p) const {
    return {static_cast<int>(std::floor(p.x_m / range_m_)), static_cast<int>(std::floor(p.y_m / range_m_))};
  }
  double range_m_;
  std::map<std::pair<int, int>, double> walls_;
};

}  // namespace

double DrawingFit::likelihood(const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                              double sigma_m) const {
  return log_likelihood(*index_, cloud, correction, WallMixture(model_, sigma_m));
}

Alignment DrawingFit::settle(const MemoryCloud& cloud, const Transform2<Map, Map>& start, bool stay) const {
  const DrawingModel plain;
  Alignment found;
  found.correction =
      refine_alignment(*index_, cloud, centre_of(cloud), start, plain, stay ? plain.sigma_m : kCatchSigmaM);
  found.likelihood = log_likelihood(*index_, cloud, found.correction, WallMixture(plain, plain.sigma_m));
  return found;
}

Alignment DrawingFit::align(const MemoryCloud& cloud, const AlignmentWindow& window) const {
  const Point2<Map> centre = centre_of(cloud);
  const double sigma = std::max(0.1, model_.sigma_m);
  const auto refined = [&](const Transform2<Map, Map>& start) {
    return refine_alignment(*index_, cloud, centre, start, model_);
  };
  Alignment best;
  // Walls draw farther than the window: what is drawn out of it lies at another place.
  if (const auto settled = refined({}); window.contains(settled, centre)) best.correction = settled;
  best.likelihood = likelihood(cloud, best.correction, sigma);
  for (const Transform2<Map, Map>& start : coarse_alignments(*index_, cloud, centre, window)) {
    const Transform2<Map, Map> correction = refined(start);
    if (!window.contains(correction, centre)) continue;
    const double value = likelihood(cloud, correction, sigma);
    if (value > best.likelihood + 0.5) {
      best.correction = correction;
      best.likelihood = value;
    }
  }
  best.gain = best.likelihood - likelihood(cloud, {}, sigma);
  return best;
}

double DrawingFit::walls_seen(const MemoryCloud& cloud) {
  double sum = 0.0;
  for (const CloudSurface& p : cloud) {
    sum += p.weight * kShareOfObservation;
  }
  return sum;
}

void DrawingFit::learn(const MemoryCloud& cloud) {
  constexpr double kLeastSigmaM = 0.02;  // no drawing is more exact
  constexpr double kPriorCount = 10.0;   // walls' worth of belief in the first guess
  constexpr double kPriorSigmaM = 0.2;
  const double all = kPriorCount + walls_seen(cloud);
  for (int round = 0; round < 5; ++round) {
    const WallMixture mixture(model_, model_.sigma_m);
    double squares = kPriorCount * kPriorSigmaM * kPriorSigmaM;
    double count = 0.0;
    for_each_hit(*index_, cloud, {}, [&](const CloudSurface& p, const auto&, const auto& hit) {
      const double share = p.weight * kShareOfObservation * mixture.is_wall(hit);
      squares += share * hit.distance_m * hit.distance_m;
      count += share;
    });
    model_.sigma_m = std::clamp(std::sqrt(squares / (kPriorCount + count)), kLeastSigmaM, 0.5);
    model_.inliers = std::clamp((count + 0.5 * kPriorCount) / all, 0.05, 0.98);
  }
}

std::vector<UnaryFactor> DrawingFit::pulls(const MemoryCloud& cloud,
                                           const std::vector<Transform2<Map, Base>>& poses,
                                           const SharedError& shared) const {
  const Neighbourhoods around(cloud, shared.range_m);
  const WallMixture mixture(model_, model_.sigma_m);
  std::vector<UnaryFactor> factors(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    factors[i].node = static_cast<int>(i);
    factors[i].at = poses[i];
  }
  for_each_hit(*index_, cloud, {}, [&](const CloudSurface& p, const auto& q, const auto& hit) {
    UnaryFactor& f = factors[static_cast<std::size_t>(p.keyframe)];
    const double variance = model_.sigma_m * model_.sigma_m +
                            std::max(0.0, around.walls_at(p) - 1.0) * shared.sigma_m * shared.sigma_m;
    const double information = p.weight * kShareOfObservation * mixture.is_wall(hit) / variance;
    const Eigen::Vector3d j = jacobian(hit, q, f.at.translation());
    f.hessian += information * j * j.transpose();
    f.gradient += information * hit.distance_m * j;
  });
  std::erase_if(factors, [](const UnaryFactor& f) { return f.hessian.isZero(0.0); });
  return factors;
}

double DrawingFit::share_on_walls(const SurfaceScan& scan, const Transform2<Map, Base>& pose) const {
  const WallMixture mixture(model_, std::max(0.05, model_.sigma_m));
  double on_walls = 0.0;
  double all = 1e-9;
  for_each_surface(*index_, scan, pose, [&](const auto&, const WallIndex::Hit& hit, double length) {
    all += length;
    on_walls += hit.wall >= 0 ? length * mixture.is_wall(hit) : 0.0;
  });
  return on_walls / all;
}

void DrawingFit::pull(const SurfaceScan& scan, const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian,
                      Eigen::Vector3d& gradient) const {
  const double variance = model_.sigma_m * model_.sigma_m;
  const WallMixture mixture(model_, model_.sigma_m);
  for_each_surface(*index_, scan, pose, [&](const Point2<Map>& q, const WallIndex::Hit& hit, double length) {
    if (hit.wall < 0) return;
    const double information = length / kVoxelM * kShareOfObservation * mixture.is_wall(hit) / variance;
    const Eigen::Vector3d j = jacobian(hit, q, pose.translation());
    hessian += information * j * j.transpose();
    gradient += information * hit.distance_m * j;
  });
}

}  // namespace madori::localization
