#include "localization/landmarks/landmark_hub.hpp"

#include <algorithm>
#include <cmath>

#include "localization/landmarks/reductions.hpp"

namespace madori::localization::landmarks {

LandmarkHub::LandmarkHub(int most_landmarks)
    : most_landmarks_(std::clamp(most_landmarks, 1, kCapacity - 1)), map_(std::make_unique<Map>()) {}

FullPose LandmarkHub::landmark(int i) const {
  if (i == 0) return {};
  return {map_->landmark(i).pose, map_->landmark(i).uncertainty};
}

std::vector<FullPose> LandmarkHub::seen_from(int landmark) const {
  std::vector<SolvedLandmark> solved;
  for (int i = 0; i < kCapacity; ++i) solved.push_back(map_->landmark(i));
  (void)solve_landmarks(map_->graph(), map_->size(), solved.data(), landmark);
  std::vector<FullPose> seen;
  for (int i = 0; i < map_->size(); ++i) seen.push_back({solved[i].pose, solved[i].uncertainty});
  return seen;
}

void LandmarkHub::measure(int from, int to, const FullPose& edge) {
  (void)map_->measure(from, to, edge);
  ++measurements_;
}

std::vector<ScalarPose> published_landmarks(const LandmarkHub& hub) {
  const auto& graph = hub.map().graph();
  const int count = hub.map().size();
  const auto scalars = std::make_unique<LandmarkGraph<ScalarUncertainty, LandmarkHub::kCapacity>>();
  for (int from = 0; from < count; ++from)
    for (NodeSet rest = graph.neighbours(from); !rest.empty();) {
      const int to = rest.take_first();
      if (to < from) continue;
      const FullPose edge = graph.edge(from, to);
      scalars->fuse(from, to, {edge.motion, ScalarUncertainty::of(edge.uncertainty.covariance)});
    }
  std::vector<ScalarPose> landmarks(1);
  for (int i = 1; i < count; ++i) landmarks.push_back(landmark_position(*scalars, count, 0, i));
  return landmarks;
}

std::optional<int> surer_landmark(const LandmarkHub& hub, int from, double variance_m2) {
  std::optional<int> best;
  NodeSet reached, front;
  reached.add(from), front.add(from);
  while (!front.empty()) {
    const int node = front.take_first();
    const double here_m2 = std::pow(position_sigma_m(hub.landmark(node).uncertainty), 2);
    if (here_m2 < variance_m2) {
      variance_m2 = here_m2;
      best = node;
    }
    for (NodeSet next = hub.map().graph().neighbours(node); !next.empty();) {
      const int other = next.take_first();
      if (!reached.has(other)) reached.add(other), front.add(other);
    }
  }
  return best;
}

double position_sigma_m(const FullUncertainty& uncertainty) {
  return std::sqrt(ScalarUncertainty::of(uncertainty.covariance).position_m2);
}

}  // namespace madori::localization::landmarks
