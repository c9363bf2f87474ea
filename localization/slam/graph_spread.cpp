#include "localization/slam/graph_spread.hpp"

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "localization/memory/fuse.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

constexpr double kRadianM = 5.0;  // of turn, when one spread is compared with another

/// One end of a factor seen from the other.
struct Tie {
  std::size_t to;
  Eigen::Matrix3d covariance;  ///< of (x, y, yaw), Map axes
};

std::vector<std::vector<Tie>> ties_of(const std::vector<Transform2<Map, Base>>& poses,
                                      const std::vector<RelativeFactor>& factors) {
  std::vector<std::vector<Tie>> ties(poses.size());
  for (const RelativeFactor& f : factors) {
    const auto from = static_cast<std::size_t>(f.from), to = static_cast<std::size_t>(f.to);
    if (contradicts(f, poses)) continue;
    const Eigen::Matrix3d own = (f.information + 1e-9 * Eigen::Matrix3d::Identity()).inverse();
    const Eigen::Matrix3d forth = in_map_axes(own, poses[from].yaw_rad());
    const Eigen::Matrix3d j = swing(poses[to], poses[from]);
    ties[from].push_back({to, forth});
    ties[to].push_back({from, j * forth * j.transpose()});
  }
  return ties;
}

double size_of(const Eigen::Matrix3d& c) {
  return c(0, 0) + c(1, 1) + kRadianM * kRadianM * c(2, 2);
}

}  // namespace

GraphSpread::GraphSpread(std::size_t from, const std::vector<Transform2<Map, Base>>& poses,
                         const std::vector<RelativeFactor>& factors)
    : here_(poses[from]), poses_(&poses), spread_(poses.size()) {
  const auto ties = ties_of(poses, factors);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<double> best(poses.size(), INFINITY);
  std::vector<char> done(poses.size(), 0);
  spread_[from] = Eigen::Matrix3d::Zero();
  best[from] = 0.0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const std::size_t k = open.top().second;
    open.pop();
    if (done[k] != 0) continue;
    done[k] = 1;
    for (const Tie& tie : ties[k]) {
      if (done[tie.to] != 0) continue;
      const Eigen::Matrix3d j = swing(poses[k], poses[tie.to]);
      const Eigen::Matrix3d there = j * *spread_[k] * j.transpose() + tie.covariance;
      if (size_of(there) >= best[tie.to]) continue;
      best[tie.to] = size_of(there);
      spread_[tie.to] = there;
      open.emplace(best[tie.to], tie.to);
    }
  }
  for (auto& spread : spread_)
    if (spread) *spread = in_map_axes(*spread, -here_.yaw_rad());
}

double GraphSpread::chi_squared(std::size_t keyframe, const Transform2<Base, Base>& motion,
                                const Eigen::Matrix3d& covariance) const {
  if (!spread_[keyframe]) return 0.0;
  const Transform2<Base, Base> by_graph = here_.inverse() * (*poses_)[keyframe];
  const Eigen::Vector3d e = pose_difference(motion, by_graph);
  const Eigen::Matrix3d sum = *spread_[keyframe] + covariance + 1e-9 * Eigen::Matrix3d::Identity();
  return e.dot(sum.inverse() * e);
}

}  // namespace madori::localization
