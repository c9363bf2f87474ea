#include "app/learned/wall_watch.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

#include "core/angle.hpp"
#include "localization/wall_reliability/reliability_file.hpp"
#include "localization/wall_reliability/wall_weights.hpp"

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
    : sensor_(sensor), learner_(walls), looks_taken_([this](const Look& look) {
        const std::scoped_lock learning(mutex_);
        learner_.observe(look.points, sensor_, look.pose);
        ++looks_;
      }) {
  const std::string message = localization::load_reliability(learned, learner_.reliability());
  if (!message.empty()) spdlog::warn("{}", message);
}

bool WallWatch::see(const localization::ScanPoints& points, const PoseEstimate& pose) {
  if (pose.health.state != LocalizationState::Localized) return false;
  if (handed_ && !is_elsewhere(*handed_, pose.map_from_base)) return false;
  handed_ = pose.map_from_base;
  looks_taken_.hand({points, pose});
  return true;
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
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const localization::WallBelief& belief = reliability.beliefs()[i];
    all.push_back({cells[i], reliability.state(i), reliability.share_in_place(i), belief.offset_m,
                   belief.missed, localization::is_surely_missing(reliability, i)});
  }
  return all;
}

}  // namespace madori::app
