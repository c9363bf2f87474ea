#include "localization/drawing_fit/drawing_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace madori::localization {
namespace {

/// Errors of a drawing persist along a wall: its pieces within two metres are one observation.
constexpr double kShare = kVoxelM / 2.0;
constexpr double kClutterWidthM = 2.0 * WallIndex::kRadiusM;
constexpr double kBeyondM = 0.3;  // a surface may overshoot a drawn wall's end by this

Transform2<Map, Map> about(const Point2<Map>& centre, double dx, double dy, double turn) {
  const Transform2<Map, Map> rotation(0.0, 0.0, turn);
  const Point2<Map> moved = rotation * centre;
  return {centre.x_m + dx - moved.x_m, centre.y_m + dy - moved.y_m, turn};
}

Point2<Map> centre_of(const MemoryCloud& cloud) {
  Point2<Map> centre;
  double sum = 0.0;
  for (const CloudSurface& p : cloud) {
    centre.x_m += p.weight * p.x_m;
    centre.y_m += p.weight * p.y_m;
    sum += p.weight;
  }
  return sum > 0.0 ? Point2<Map>{centre.x_m / sum, centre.y_m / sum} : centre;
}

int turned_direction(const CloudSurface& p, const Transform2<Map, Map>& by) {
  return WallIndex::direction_of(by.cos_yaw() * p.normal_x - by.sin_yaw() * p.normal_y,
                                 by.sin_yaw() * p.normal_x + by.cos_yaw() * p.normal_y);
}

/// The two-sided story of a residual: a drawn wall with Gaussian error, or clutter anywhere.
struct Mixture {
  Mixture(const DrawingModel& model, double sigma) : sigma_m(sigma) {
    const double inliers = std::clamp(model.inliers, 0.05, 0.98);
    peak = inliers / (1.0 - inliers) * kClutterWidthM / (sigma * std::sqrt(2.0 * kPi));
  }
  /// Odds of wall against clutter.
  [[nodiscard]] double odds(double distance_m) const {
    const double z = distance_m / sigma_m;
    return peak * std::exp(-0.5 * z * z);
  }
  [[nodiscard]] double is_wall(double distance_m) const {
    const double o = odds(distance_m);
    return o / (1.0 + o);
  }
  double sigma_m;
  double peak;
};

/// Calls visit(surface, place after the correction, hit) for each surface that has a wall to belong to.
template <class Visit>
void for_each_hit(const WallIndex& index, const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                  Visit&& visit) {
  for (const CloudSurface& p : cloud) {
    const Point2<Map> q = correction * Point2<Map>{p.x_m, p.y_m};
    const WallIndex::Hit hit = index.nearest(q.x_m, q.y_m, turned_direction(p, correction));
    if (hit.wall >= 0 && hit.beyond_m <= kBeyondM) {
      visit(p, q, hit);
    }
  }
}

/// Of the signed distance to the wall's line, by a motion (dx, dy, turn about pivot).
Eigen::Vector3d jacobian(const WallIndex::Hit& hit, const Point2<Map>& q, const Point2<Map>& pivot) {
  return {hit.normal_x, hit.normal_y,
          -hit.normal_x * (q.y_m - pivot.y_m) + hit.normal_y * (q.x_m - pivot.x_m)};
}

double sum_of_nats(const WallIndex& index, const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                   const Mixture& mixture) {
  double sum = 0.0;
  for_each_hit(index, cloud, correction, [&](const CloudSurface& p, const auto&, const auto& hit) {
    sum += p.weight * kShare * std::log1p(mixture.odds(hit.distance_m));
  });
  return sum;
}

}  // namespace

double DrawingFit::likelihood(const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                              double sigma_m) const {
  return sum_of_nats(*index_, cloud, correction, Mixture(model_, sigma_m));
}

Alignment DrawingFit::settle(const MemoryCloud& cloud, const Transform2<Map, Map>& start) const {
  const DrawingModel plain;
  Alignment found;
  found.correction = refine(cloud, centre_of(cloud), start, plain);
  found.likelihood = sum_of_nats(*index_, cloud, found.correction, Mixture(plain, plain.sigma_m));
  return found;
}

Transform2<Map, Map> DrawingFit::refine(const MemoryCloud& cloud, const Point2<Map>& centre,
                                        Transform2<Map, Map> correction, const DrawingModel& model) const {
  for (int i = 0; i < 12; ++i) {
    const Mixture mixture(model, std::max(model.sigma_m, 0.35 * std::pow(0.75, i)));
    const Point2<Map> pivot = correction * centre;
    Eigen::Matrix3d h = 1e-3 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for_each_hit(*index_, cloud, correction, [&](const CloudSurface& p, const auto& q, const auto& hit) {
      const double weight = p.weight * mixture.is_wall(hit.distance_m);
      const Eigen::Vector3d j = jacobian(hit, q, pivot);
      h += weight * j * j.transpose();
      g += weight * hit.distance_m * j;
    });
    const Eigen::Vector3d step = -h.ldlt().solve(g);
    correction = about(pivot, step[0], step[1], step[2]) * correction;
  }
  return correction;
}

std::vector<Transform2<Map, Map>> DrawingFit::coarse(const MemoryCloud& cloud, const Point2<Map>& centre,
                                                     const AlignmentWindow& window) const {
  static const auto blur = [] {
    constexpr float kBlurCm = 22.0F;
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < 255; ++i) {
      const float z = static_cast<float>(i) / kBlurCm;
      t[i] = std::exp(-0.5F * z * z);
    }
    return t;
  }();
  struct Found {
    double score;
    Transform2<Map, Map> correction;
  };
  std::vector<Found> found;
  constexpr double kStepM = 0.2;
  constexpr double kStepRad = 0.03;
  const int reach = static_cast<int>(std::ceil(window.half_m / kStepM));
  const int turns = static_cast<int>(std::ceil(window.half_rad / kStepRad));
  const std::size_t stride = cloud.size() / window.sample + 1;
  for (int r = -turns; r <= turns; ++r) {
    const auto turned = about(centre, 0.0, 0.0, r * kStepRad);
    std::vector<CloudSurface> sample;
    for (std::size_t i = 0; i < cloud.size(); i += stride) {
      const Point2<Map> q = turned * Point2<Map>{cloud[i].x_m, cloud[i].y_m};
      sample.push_back({q.x_m, q.y_m, 0.0, 0.0, 0, turned_direction(cloud[i], turned), 1, cloud[i].weight});
    }
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        double score = 0.0;
        for (const CloudSurface& p : sample) {
          score += p.weight * blur[index_->centimetres(p.x_m + x * kStepM, p.y_m + y * kStepM, p.direction)];
        }
        found.push_back({score, about(centre, x * kStepM, y * kStepM, r * kStepRad)});
      }
    }
  }
  const std::size_t kept = std::min<std::size_t>(6, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<long>(kept), found.end(),
                    [](const Found& a, const Found& b) { return a.score > b.score; });
  std::vector<Transform2<Map, Map>> best;
  for (std::size_t i = 0; i < kept; ++i) {
    best.push_back(found[i].correction);
  }
  return best;
}

Alignment DrawingFit::align(const MemoryCloud& cloud, const AlignmentWindow& window) const {
  const Point2<Map> centre = centre_of(cloud);
  const double sigma = std::max(0.1, model_.sigma_m);
  Alignment best;
  best.correction = refine(cloud, centre, {}, model_);
  best.likelihood = likelihood(cloud, best.correction, sigma);
  for (const Transform2<Map, Map>& start : coarse(cloud, centre, window)) {
    const Transform2<Map, Map> correction = refine(cloud, centre, start, model_);
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
    sum += p.weight * kShare;
  }
  return sum;
}

void DrawingFit::learn(const MemoryCloud& cloud) {
  constexpr double kPriorCount = 10.0;  // walls' worth of belief in the first guess
  constexpr double kPriorSigmaM = 0.2;
  const double all = kPriorCount + walls_seen(cloud);
  for (int round = 0; round < 5; ++round) {
    const Mixture mixture(model_, model_.sigma_m);
    double squares = kPriorCount * kPriorSigmaM * kPriorSigmaM;
    double count = 0.0;
    for_each_hit(*index_, cloud, {}, [&](const CloudSurface& p, const auto&, const auto& hit) {
      const double share = p.weight * kShare * mixture.is_wall(hit.distance_m);
      squares += share * hit.distance_m * hit.distance_m;
      count += share;
    });
    model_.sigma_m = std::clamp(std::sqrt(squares / (kPriorCount + count)), 0.02, 0.5);
    model_.inliers = std::clamp((count + 0.5 * kPriorCount) / all, 0.05, 0.98);
  }
}

std::vector<UnaryFactor> DrawingFit::pulls(const MemoryCloud& cloud,
                                           const std::vector<Transform2<Map, Base>>& poses) const {
  std::vector<UnaryFactor> factors(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    factors[i].node = static_cast<int>(i);
    factors[i].at = poses[i];
  }
  const double sigma = model_.sigma_m;
  const Mixture mixture(model_, sigma);
  for_each_hit(*index_, cloud, {}, [&](const CloudSurface& p, const auto& q, const auto& hit) {
    UnaryFactor& f = factors[static_cast<std::size_t>(p.keyframe)];
    const double information = p.weight * kShare * mixture.is_wall(hit.distance_m) / (sigma * sigma);
    const Eigen::Vector3d j = jacobian(hit, q, f.at.translation());
    f.hessian += information * j * j.transpose();
    f.gradient += information * hit.distance_m * j;
  });
  std::erase_if(factors, [](const UnaryFactor& f) { return f.hessian.isZero(0.0); });
  return factors;
}

namespace {

/// Calls visit(place, hit, length) for each directed point of a scan; `hit.wall` is -1 where none is near.
template <class Visit>
void for_each_surface(const WallIndex& index, const SurfaceScan& scan, const Transform2<Map, Base>& pose,
                      Visit&& visit) {
  for (std::size_t i = 1; i < scan.points.size(); ++i) {
    const SurfacePoint& p = scan.points[i];
    if (!p.has_normal()) continue;
    const Point2<Map> q = pose * Point2<Base>{p.x_m, p.y_m};
    const double nx = pose.cos_yaw() * p.normal_x - pose.sin_yaw() * p.normal_y;
    const double ny = pose.sin_yaw() * p.normal_x + pose.cos_yaw() * p.normal_y;
    WallIndex::Hit hit = index.nearest(q.x_m, q.y_m, WallIndex::direction_of(nx, ny));
    if (hit.beyond_m > kBeyondM) hit.wall = -1;
    const double gap = std::hypot(p.x_m - scan.points[i - 1].x_m, p.y_m - scan.points[i - 1].y_m);
    visit(q, hit, std::min(kVoxelM, gap));
  }
}

}  // namespace

double DrawingFit::share_on_walls(const SurfaceScan& scan, const Transform2<Map, Base>& pose) const {
  const Mixture mixture(model_, std::max(0.05, model_.sigma_m));
  double on_walls = 0.0;
  double all = 1e-9;
  for_each_surface(*index_, scan, pose, [&](const auto&, const WallIndex::Hit& hit, double length) {
    all += length;
    on_walls += hit.wall >= 0 ? length * mixture.is_wall(hit.distance_m) : 0.0;
  });
  return on_walls / all;
}

void DrawingFit::pull(const SurfaceScan& scan, const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian,
                      Eigen::Vector3d& gradient) const {
  const double variance = model_.sigma_m * model_.sigma_m;
  const Mixture mixture(model_, model_.sigma_m);
  for_each_surface(*index_, scan, pose, [&](const Point2<Map>& q, const WallIndex::Hit& hit, double length) {
    if (hit.wall < 0) return;
    const double information = length / kVoxelM * kShare * mixture.is_wall(hit.distance_m) / variance;
    const Eigen::Vector3d j = jacobian(hit, q, pose.translation());
    hessian += information * j * j.transpose();
    gradient += information * hit.distance_m * j;
  });
}

}  // namespace madori::localization
