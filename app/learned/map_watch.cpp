#include "app/learned/map_watch.hpp"

#include <utility>

#include "hmi/server/thread_priority.hpp"

namespace madori::app {

MapWatch::MapWatch(localization::HybridMap begun) : learner_(std::move(begun)) {
  thread_ = std::thread([this] { run(); });
}

MapWatch::~MapWatch() {
  {
    const std::scoped_lock lock(mailbox_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool MapWatch::see(const PointCloud<Base>& sweep, const LidarModel& lidar, const PoseEstimate& pose) {
  if (!localization::MapLearner::is_sure(pose)) return false;
  if (handed_ && !localization::MapLearner::is_later(*handed_, pose.stamp)) return false;
  handed_ = pose.stamp;
  {
    const std::scoped_lock lock(mailbox_);
    waiting_ = Look{sweep, lidar, pose};
  }
  wake_.notify_one();
  return true;
}

void MapWatch::run() {
  (void)hmi::run_behind_the_cycle();
  std::unique_lock lock(mailbox_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || waiting_; });
    if (stop_) return;
    const Look look = *std::exchange(waiting_, std::nullopt);
    lock.unlock();
    const auto beams = localization::beams_of(look.sweep, look.lidar);
    {
      const std::scoped_lock learning(mutex_);
      learner_.look(beams, look.pose);
    }
    lock.lock();
  }
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
