#include "app/learned/map_watch.hpp"

#include <utility>

namespace madori::app {

MapWatch::MapWatch(localization::HybridMap begun)
    : learner_(std::move(begun)), looks_taken_([this](const Look& look) {
        const auto beams = localization::beams_of(look.sweep, look.lidar);
        const std::scoped_lock learning(mutex_);
        learner_.look(beams, look.pose);
      }) {}

bool MapWatch::see(const PointCloud<Base>& sweep, const LidarModel& lidar, const PoseEstimate& pose) {
  if (!localization::MapLearner::is_sure(pose)) return false;
  if (handed_ && !localization::MapLearner::is_later(*handed_, pose.stamp)) return false;
  handed_ = pose.stamp;
  looks_taken_.hand({sweep, lidar, pose});
  return true;
}

localization::HybridMap MapWatch::map() const {
  const std::scoped_lock lock(mutex_);
  return learner_.map();
}

std::size_t MapWatch::looks() const {
  const std::scoped_lock lock(mutex_);
  return learner_.looks();
}

}  // namespace madori::app
