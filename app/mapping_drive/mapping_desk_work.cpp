// What the desk does with what it is given, on its own thread.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/mapping_drive/mapping_desk.hpp"
#include "core/failure_words.hpp"

namespace madori::app {
namespace {

constexpr double kLostM = 0.3;
constexpr int kLostScans = 4;
constexpr double kSyncS = 5.0;
constexpr double kPictureS = 1.0;
constexpr double kPictureShare = 0.05;  ///< of the thread's time at most

}  // namespace

/// A drive that was not read to its end is left as it is: it is somebody else's to go on with.
void MappingDesk::read_earlier(const std::stop_token& stop) {
  try {
    const std::uintmax_t whole = read_drive(
        options_.journal, {.on_odometry = [this](const OdometryReading& reading) { take(reading); },
                           .on_scan =
                               [this](const DriveScan& scan) {
                                 take({scan, last_ ? last_->odom_from_base : Transform2<Odom, Base>()});
                                 if (count_.scans % 20 == 0) tell(true);
                               },
                           .stop = stop});
    if (whole > 0 && stop.stop_requested()) return;
    journal_.emplace(options_.journal, whole);
  } catch (const std::exception& e) {
    count_.problem = failure_words(e);
  }
  draw_picture();
  tell(false);
}

void MappingDesk::work(const Item& item) {
  if (const auto* reading = std::get_if<OdometryReading>(&item)) {
    if (!drive_from_odom_) join();
    const OdometryReading kept =
        as_kept({reading->stamp + later_, *drive_from_odom_ * reading->odom_from_base});
    if (journal_) journal_->add(kept);
    return take(kept);
  }
  GivenScan given = std::get<GivenScan>(item);
  if (!drive_from_odom_) return;
  given.scan.stamp += later_;
  if (journal_) {
    journal_->add(given.scan);
    if (to_seconds(given.scan.stamp - synced_) > kSyncS) {
      journal_->sync();
      synced_ = given.scan.stamp;
    }
    count_.problem = journal_->problem();
  }
  const Transform2<Odom, Base> real = given.odom_from_base;
  given.odom_from_base = *drive_from_odom_ * real;
  take(given);
  {
    const std::scoped_lock lock(mutex_);
    if (newest_) newest_->odom_from_base = real;
  }
  draw_picture();
  tell(false);
}

/// What goes on begins where the drive that was read ended: by the wheels it has not moved since. That holds
/// of the first reading alone, which may not be among those that still wait.
void MappingDesk::join() {
  drive_from_odom_.emplace();
  if (!last_) return;
  const std::scoped_lock lock(mutex_);
  drive_from_odom_ = last_->odom_from_base * begun_.odom_from_base.inverse();
  constexpr Duration kPause = std::chrono::seconds(1);
  if (begun_.stamp <= last_->stamp) later_ = last_->stamp + kPause - begun_.stamp;
  if (newest_) newest_->odom_from_base = begun_.odom_from_base;
}

void MappingDesk::take(const OdometryReading& reading) {
  (void)mapper_.on_odometry(reading);
  last_ = reading;
}

void MappingDesk::take(const GivenScan& given) {
  localization::ScanPoints points;
  for (const auto& p : given.scan.points) points.add(p.x_m, p.y_m);
  note(mapper_.on_scan(given.scan.stamp, points, given.scan.sensor), given.odom_from_base);
}

void MappingDesk::note(const PoseEstimate& pose, const Transform2<Odom, Base>& moved_to) {
  const double step_m = last_scan_ ? distance_m(last_scan_->translation(), moved_to.translation()) : 0.0;
  last_scan_ = moved_to;
  const bool found = pose.health.state == LocalizationState::Localized;
  const std::size_t keyframes = mapper_.memory().size();
  if (!found && lost_scans_ == 0 && !count_.lost) broken_at_ = keyframes - 1;
  lost_m_ = found ? 0.0 : lost_m_ + step_m;
  lost_scans_ = found ? 0 : lost_scans_ + 1;
  ++count_.scans;
  count_.driven_m += step_m;
  // What comes behind a break fits itself: only what was seen before tells that the drive is tied again.
  const bool changed = keyframes != count_.keyframes || mapper_.memory().loops() != count_.loops;
  if (lost_m_ > kLostM || lost_scans_ >= kLostScans)
    count_.lost = true;
  else if (count_.lost && found && changed)
    count_.lost = !mapper_.lies_on_earlier(broken_at_);
  count_.keyframes = keyframes;
  count_.loops = mapper_.memory().loops();
  const std::scoped_lock lock(mutex_);
  newest_ = MappedPose{pose, moved_to};
}

void MappingDesk::tell(bool reading) {
  const std::scoped_lock lock(mutex_);
  told_ = count_;
  told_.reading = reading;
}

void MappingDesk::draw_picture() {
  const localization::Memory& memory = mapper_.memory();
  const auto now = std::chrono::steady_clock::now();
  const double since_s = std::chrono::duration<double>(now - drawn_at_).count();
  const bool same = memory.size() == drawn_keyframes_ && memory.loops() == drawn_loops_;
  if (same || since_s < std::max(kPictureS, picture_cost_s_ / kPictureShare)) return;
  auto picture = std::make_shared<MappingPicture>(picture_of(mapper_.shown()));
  drawn_keyframes_ = memory.size();
  drawn_loops_ = memory.loops();
  drawn_at_ = std::chrono::steady_clock::now();
  picture_cost_s_ = std::chrono::duration<double>(drawn_at_ - now).count();
  const std::scoped_lock lock(mutex_);
  picture->revision = picture_->revision + 1;
  picture_ = std::move(picture);
}

}  // namespace madori::app
