#include "localization/drawing_fit/alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/drawing_fit/wall_hits.hpp"

namespace madori::localization {
namespace {

/// A turn about the centre, then a shift.
Transform2<Map, Map> about(const Point2<Map>& centre, double dx, double dy, double turn) {
  const Transform2<Map, Map> rotation(0.0, 0.0, turn);
  const Point2<Map> moved = rotation * centre;
  return {centre.x_m + dx - moved.x_m, centre.y_m + dy - moved.y_m, turn};
}

/// Every `stride`-th surface after `turned`; places, directions and weights only.
MemoryCloud turned_sample(const MemoryCloud& cloud, const Transform2<Map, Map>& turned, std::size_t stride) {
  MemoryCloud sample;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    const Point2<Map> q = turned * Point2<Map>{cloud[i].x_m, cloud[i].y_m};
    sample.push_back({q.x_m, q.y_m, 0.0, 0.0, 0, turned_direction(cloud[i], turned), 1, cloud[i].weight});
  }
  return sample;
}

double score_shifted(const WallIndex& index, const MemoryCloud& sample, double dx, double dy) {
  constexpr float kBlurCm = 22.0F;  // wide enough that a step of the grid does not miss the peak
  static const auto blur = scores_by_centimetre(kBlurCm);
  double score = 0.0;
  for (const CloudSurface& p : sample) {
    score += p.weight * blur[index.centimetres(p.x_m + dx, p.y_m + dy, p.direction)];
  }
  return score;
}

struct Candidate {
  double score;
  Transform2<Map, Map> correction;
};

std::vector<Transform2<Map, Map>> best_few(std::vector<Candidate> found) {
  const std::size_t kept = std::min<std::size_t>(6, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<long>(kept), found.end(),
                    [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Transform2<Map, Map>> best;
  for (std::size_t i = 0; i < kept; ++i) {
    best.push_back(found[i].correction);
  }
  return best;
}

}  // namespace

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

double log_likelihood(const WallIndex& index, const MemoryCloud& cloud,
                      const Transform2<Map, Map>& correction, const WallMixture& mixture) {
  double sum = 0.0;
  for_each_hit(index, cloud, correction, [&](const CloudSurface& p, const auto&, const auto& hit) {
    sum += p.weight * kShareOfObservation * std::log1p(mixture.odds(hit));
  });
  return sum;
}

std::vector<Transform2<Map, Map>> coarse_alignments(const WallIndex& index, const MemoryCloud& cloud,
                                                    const Point2<Map>& centre,
                                                    const AlignmentWindow& window) {
  constexpr double kStepM = 0.2;
  constexpr double kStepRad = 0.03;
  const int reach = static_cast<int>(std::ceil(window.half_m / kStepM));
  const int turns = static_cast<int>(std::ceil(window.half_rad / kStepRad));
  const std::size_t stride = cloud.size() / window.sample + 1;
  std::vector<Candidate> found;
  for (int r = -turns; r <= turns; ++r) {
    const MemoryCloud sample = turned_sample(cloud, about(centre, 0.0, 0.0, r * kStepRad), stride);
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        found.push_back({score_shifted(index, sample, x * kStepM, y * kStepM),
                         about(centre, x * kStepM, y * kStepM, r * kStepRad)});
      }
    }
  }
  return best_few(std::move(found));
}

Transform2<Map, Map> refine_alignment(const WallIndex& index, const MemoryCloud& cloud,
                                      const Point2<Map>& centre, Transform2<Map, Map> correction,
                                      const DrawingModel& model, double first_sigma_m) {
  for (int i = 0; i < 12; ++i) {
    const WallMixture mixture(model, std::max(model.sigma_m, first_sigma_m * std::pow(0.75, i)));
    const Point2<Map> pivot = correction * centre;
    Eigen::Matrix3d h = 1e-3 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for_each_hit(index, cloud, correction, [&](const CloudSurface& p, const auto& q, const auto& hit) {
      const double weight = p.weight * mixture.is_wall(hit);
      const Eigen::Vector3d j = jacobian(hit, q, pivot);
      h += weight * j * j.transpose();
      g += weight * hit.distance_m * j;
    });
    const Eigen::Vector3d step = -h.ldlt().solve(g);
    correction = about(pivot, step[0], step[1], step[2]) * correction;
  }
  return correction;
}

}  // namespace madori::localization
