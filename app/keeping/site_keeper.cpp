#include "app/keeping/site_keeper.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "app/learned/calibration_file.hpp"
#include "app/learned/day_of_map.hpp"
#include "app/learned/deviations.hpp"
#include "app/learned/kept_memory.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/living_map_file.hpp"
#include "core/clock.hpp"
#include "localization/self_calibration/self_calibration.hpp"
#include "localization/warp/warp_file.hpp"
#include "mapping/days/day_archive.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {
namespace {

constexpr double kPoseEveryS = 1.0;
constexpr double kLearnedEveryS = 60.0;

/// What the living map reads today.
void keep_today(const std::filesystem::path& site, const localization::HybridMap& map,
                const std::string& frame) try {
  const Stamp now = clock_now();
  if (const auto day = day_of(map, frame, time_of_day(now) - now)) mapping::keep_day(site, *day);
} catch (const std::exception& e) {
  spdlog::warn("today is not kept: {}", e.what());
}

}  // namespace

SiteKeeper::Learned::Learned(std::filesystem::path folder)
    : site(std::move(folder)),
      memory(site / kMemoryFile),
      map(site / kLivingMapFile),
      warp(site / kWarpFile),
      reliability(site / kReliabilityFile) {}

SiteKeeper::SiteKeeper(Learned learned, const mapping::Walls& walls, std::shared_ptr<const WallWatch> watch,
                       std::shared_ptr<const MapWatch> map_watch, std::string frame)
    : site_(learned.site),
      walls_(walls),
      fingerprint_(mapping::walls_fingerprint(walls)),
      frame_(std::move(frame)),
      watch_(std::move(watch)),
      map_watch_(std::move(map_watch)),
      learned_(std::move(learned)) {}

SiteKeeper::~SiteKeeper() {
  finish_learning();
  jobs_.wait();
}

void SiteKeeper::finish_learning() {
  if (watch_) keep_learned();
  watch_.reset();
}

void SiteKeeper::observe(const CycleState& state, Stamp now) {
  if (!state.drive_heard) return;
  const WheelCounters wheels = counters_of(state.drive);
  const bool stands = wheels == wheels_before_;
  const bool came_to_stand = stands && !stood_;
  wheels_before_ = wheels;
  stood_ = stands;
  if (state.pose.health.state == LocalizationState::Localized) {
    bent_ = state.site->bent();
    if (came_to_stand || to_seconds(now - memory_taken_) >= kLearnedEveryS) take_memory(state, now);
  }
  if (came_to_stand || to_seconds(now - pose_kept_) >= kPoseEveryS) keep_pose(state, now);
  if (watch_ && stands && to_seconds(now - learned_kept_) >= kLearnedEveryS) {
    if (learned_kept_ != Stamp{}) keep_learned();
    learned_kept_ = now;
  }
}

void SiteKeeper::take_memory(const CycleState& state, Stamp now) {
  memory_taken_ = now;
  if (auto memory = state.localization->remembered()) memory_ = std::move(memory);
}

/// A vehicle that is lost may have been carried away with its wheels still: then no pose is better.
void SiteKeeper::keep_pose(const CycleState& state, Stamp now) {
  const auto file = site_ / kPoseFile;
  if (state.pose.health.state == LocalizationState::Lost && pose_known_) {
    pose_known_ = false;
    pose_kept_ = now;
    jobs_.put("pose", [file] { std::filesystem::remove(file); });
  }
  const WheelCounters wheels = counters_of(state.drive);
  if (state.pose.health.state != LocalizationState::Localized) return;
  if (pose_known_ && same_place(wheels, kept_wheels_)) return;
  pose_known_ = true;
  pose_kept_ = now;
  kept_wheels_ = wheels;
  const StoredPose pose{time_of_day(now), state.site->on_drawing(state.pose.map_from_base),
                        state.pose.covariance, wheels, fingerprint_};
  jobs_.put("pose", [file, pose] { mapping::write_file_atomically(file, stored_pose_yaml(pose)); });
}

void SiteKeeper::keep_learned() {
  jobs_.put("learned", [site = site_, walls = walls_, watch = watch_, map = map_watch_, bent = bent_,
                        memory = memory_, files = &learned_, frame = frame_] {
    if (memory) files->memory.write([&] { save_memory(site, memory->together(), walls); });
    const auto seen = map ? std::optional(map->map()) : std::nullopt;
    const bool map_kept = seen && files->map.write([&] { save_living_map(site, *seen, walls); });
    if (bent) files->warp.write([&] { localization::save_warp(site / kWarpFile, bent->fit, walls); });
    files->reliability.write(
        [&] { mapping::write_file_atomically(site / kReliabilityFile, watch->reliability_text()); });
    const auto found = localization::self_calibrate(localization::WallIndex(walls), watch->keyframes());
    (void)keep_calibration(site, walls, found);
    if (map_kept && !frame.empty()) keep_today(site, *seen, frame);
  });
}

}  // namespace madori::app
