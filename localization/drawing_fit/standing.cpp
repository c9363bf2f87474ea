#include "localization/drawing_fit/standing.hpp"

#include <vector>

#include "localization/memory/sights.hpp"

namespace madori::localization {
namespace {

constexpr double kStopM = 0.4;        ///< keyframes this near to the first of a stop belong to it
constexpr double kLeastCosine = 0.3;  ///< between ray and normal

/// Votes for one surface.
struct SurfaceVotes {
  double hits = 0.0, through = 0.0;     ///< of the stops so far
  int hits_here = 0, through_here = 0;  ///< looks of the stop that is being counted
};

/// What a keyframe says of each surface in its reach.
void look(const SightRing& ring, const Transform2<Map, Base>& pose, const MemoryCloud& cloud,
          std::vector<SurfaceVotes>& votes) {
  const Point2<Map> eye = pose * ring.sensor();
  const Transform2<Base, Map> base_from_map = pose.inverse();
  const double reach_sq = ring.reach_m() * ring.reach_m();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double dx = cloud[i].x_m - eye.x_m, dy = cloud[i].y_m - eye.y_m;
    const double distance_sq = dx * dx + dy * dy;
    if (distance_sq > reach_sq) continue;
    const double across = dx * cloud[i].normal_x + dy * cloud[i].normal_y;
    if (across * across < kLeastCosine * kLeastCosine * distance_sq) continue;
    const Look seen = ring.at(base_from_map * Point2<Map>{cloud[i].x_m, cloud[i].y_m});
    votes[i].hits_here += seen == Look::Hit ? 1 : 0;
    votes[i].through_here += seen == Look::Through ? 1 : 0;
  }
}

/// A stop is over: its vote.
void count(std::vector<SurfaceVotes>& votes) {
  for (SurfaceVotes& v : votes) {
    const int looks = v.hits_here + v.through_here;
    if (looks == 0) continue;
    v.hits += static_cast<double>(v.hits_here) / looks;
    v.through += static_cast<double>(v.through_here) / looks;
    v.hits_here = v.through_here = 0;
  }
}

}  // namespace

MemoryCloud standing_cloud(const Memory& memory) {
  MemoryCloud cloud = memory_cloud(memory);
  std::vector<SurfaceVotes> votes(cloud.size());
  Point2<Map> stop;
  for (std::size_t k = 0; k < memory.size(); ++k) {
    const Transform2<Map, Base>& pose = memory.poses()[k];
    if (k == 0 || distance_m(stop, pose.translation()) > kStopM) {
      count(votes);
      stop = pose.translation();
    }
    look(SightRing(*memory.keyframes()[k].scan), pose, cloud, votes);
  }
  count(votes);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double looks = votes[i].hits + votes[i].through;
    cloud[i].standing = looks > 0.0 ? votes[i].hits / looks : 1.0;
  }
  return cloud;
}

}  // namespace madori::localization
