#include "app/learned/wall_watch.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "core/angle.hpp"
#include "hmi/server/thread_priority.hpp"
#include "localization/wall_reliability/reliability_file.hpp"

namespace madori::app {
namespace {

constexpr double kStep_m = 0.25;
constexpr double kStep_rad = 0.25;

bool is_elsewhere(const Transform2<Map, Base>& a, const Transform2<Map, Base>& b) {
  return distance_m(a.translation(), b.translation()) > kStep_m ||
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) > kStep_rad;
}

}  // namespace

WallWatch::WallWatch(const mapping::Walls& walls, const Point2<Base>& sensor,
                     const std::filesystem::path& learned)
    : sensor_(sensor), learner_(walls) {
  const std::string message = localization::load_reliability(learned, learner_.reliability());
  if (!message.empty()) spdlog::warn("{}", message);
  thread_ = std::thread([this] { run(); });
}

WallWatch::~WallWatch() {
  {
    const std::scoped_lock lock(mailbox_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool WallWatch::see(const localization::ScanPoints& points, const PoseEstimate& pose) {
  if (pose.health.state != LocalizationState::Localized) return false;
  if (handed_ && !is_elsewhere(*handed_, pose.map_from_base)) return false;
  handed_ = pose.map_from_base;
  {
    const std::scoped_lock lock(mailbox_);
    waiting_ = Look{points, pose};
  }
  wake_.notify_one();
  return true;
}

void WallWatch::run() {
  (void)hmi::run_behind_the_cycle();
  std::unique_lock lock(mailbox_);
  while (true) {
    wake_.wait(lock, [this] { return stop_ || waiting_; });
    if (stop_) return;
    const Look look = *std::exchange(waiting_, std::nullopt);
    lock.unlock();
    {
      const std::scoped_lock learning(mutex_);
      learner_.observe(look.points, sensor_, look.pose);
      ++looks_;
    }
    lock.lock();
  }
}

std::size_t WallWatch::looks() const {
  const std::scoped_lock lock(mutex_);
  return looks_;
}

std::string WallWatch::reliability_text() const {
  const std::scoped_lock lock(mutex_);
  return localization::reliability_csv(learner_.reliability());
}

std::vector<localization::CalibrationKeyframe> WallWatch::keyframes() const {
  const std::scoped_lock lock(mutex_);
  return learner_.keyframes();
}

std::vector<SeenWall> WallWatch::seen() const {
  const std::scoped_lock lock(mutex_);
  std::vector<SeenWall> all;
  const localization::WallReliability& reliability = learner_.reliability();
  const auto& cells = reliability.cells().all();
  all.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    all.push_back(
        {cells[i], reliability.state(i), reliability.share_in_place(i), reliability.beliefs()[i].offset_m});
  return all;
}

}  // namespace madori::app
