#include "app/mapping_drive/mapping_desk.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/thread_role.hpp"
#include "localization/localizer/options.hpp"

namespace madori::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostWaitingScans = 20;  ///< two seconds of a lidar that turns at 10 Hz
constexpr std::size_t kMostWaiting = 2000;     ///< readings of the wheels with them
constexpr double kStepM = 0.04;                ///< between two scans that the mapper gets,
constexpr double kStepRad = 0.0175;            ///< or this much turning
constexpr double kLostM = 0.3;
constexpr int kLostScans = 4;
constexpr double kSyncS = 5.0;
constexpr double kPictureS = 1.0;
constexpr auto kPicturePause = std::chrono::seconds(1);
constexpr double kPictureShare = 0.05;  ///< of the thread's time at most

double way_m(const Transform2<Odom, Base>& from, const Transform2<Odom, Base>& to) {
  return distance_m(from.translation(), to.translation());
}

bool moved(const Transform2<Odom, Base>& from, const Transform2<Odom, Base>& to) {
  return way_m(from, to) > kStepM || std::abs(wrap_angle(to.yaw_rad() - from.yaw_rad())) > kStepRad;
}

/// As a file gives it back, to the bit.
OdometryReading as_kept(const OdometryReading& r) {
  const auto& p = r.odom_from_base;
  return {r.stamp, {p.x_m(), p.y_m(), p.yaw_rad()}};
}

}  // namespace

MappingDesk::MappingDesk(Options options)
    : options_(std::move(options)), mapper_(localization::driving_options()) {
  told_.reading = true;
  if (options_.beside)
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  else
    read_earlier();
}

MappingDesk::~MappingDesk() = default;

void MappingDesk::put(Item item) {
  if (!options_.beside) return work(item);
  {
    const std::scoped_lock lock(mutex_);
    const bool scan = std::holds_alternative<GivenScan>(item);
    waiting_.push_back(std::move(item));
    waiting_scans_ += scan ? 1 : 0;
    const auto is_scan = [](const Item& i) { return std::holds_alternative<GivenScan>(i); };
    if (waiting_scans_ > kMostWaitingScans) drop(std::ranges::find_if(waiting_, is_scan));
    if (waiting_.size() > kMostWaiting) drop(waiting_.begin());
  }
  changed_.notify_all();
}

/// Readings of the wheels are places, not steps: the next one says all that one that is dropped did.
void MappingDesk::drop(std::deque<Item>::iterator item) {
  if (std::holds_alternative<GivenScan>(*item)) --waiting_scans_, ++dropped_;
  waiting_.erase(item);
}

/// A standing vehicle has nothing to say; before it moves on it says once more that it stood.
void MappingDesk::on_odometry(const OdometryReading& reading) {
  const bool stands = given_ && way_m(given_->odom_from_base, reading.odom_from_base) == 0.0 &&
                      given_->odom_from_base.yaw_rad() == reading.odom_from_base.yaw_rad();
  if (stands) {
    held_ = reading;
    return;
  }
  if (held_) put(as_kept(*std::exchange(held_, std::nullopt)));
  if (!given_) {
    const std::scoped_lock lock(mutex_);
    begun_ = as_kept(reading);
  }
  given_ = reading;
  put(as_kept(reading));
}

void MappingDesk::on_scan(DriveScan scan, const Transform2<Odom, Base>& odom_from_base) {
  if (!given_ || (scanned_ && !moved(*scanned_, odom_from_base))) return;
  scanned_ = odom_from_base;
  if (held_) put(as_kept(*std::exchange(held_, std::nullopt)));
  put(GivenScan{std::move(scan), odom_from_base});
}

std::optional<MappedPose> MappingDesk::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

MappingProgress MappingDesk::progress() const {
  const std::scoped_lock lock(mutex_);
  MappingProgress now = told_;
  now.dropped = dropped_;
  now.waiting = waiting_scans_;
  return now;
}

std::shared_ptr<const MappingPicture> MappingDesk::picture() const {
  const std::scoped_lock lock(mutex_);
  return picture_;
}

localization::FinishedMap MappingDesk::finish() {
  if (!options_.beside) return mapper_.finish();
  std::future<localization::FinishedMap> answer;
  {
    const std::scoped_lock lock(mutex_);
    asked_.emplace();
    answer = asked_->get_future();
  }
  changed_.notify_all();
  return answer.get();
}

void MappingDesk::run(const std::stop_token& stop) {
  (void)take_role("mapping", ThreadRole::Ordinary);
  read_earlier();
  std::unique_lock lock(mutex_);
  const auto wanted = [this] { return !waiting_.empty() || asked_; };
  for (;;) {  // what still waits when it ends is worked on, and so kept
    if (!changed_.wait_for(lock, stop, kPicturePause, wanted)) {
      if (stop.stop_requested()) break;
      lock.unlock();  // what came last is drawn, too
      draw_picture();
      lock.lock();
      continue;
    }
    if (waiting_.empty()) {
      auto asked = *std::exchange(asked_, std::nullopt);
      lock.unlock();
      try {
        asked.set_value(mapper_.finish());
      } catch (...) {
        asked.set_exception(std::current_exception());
      }
      lock.lock();
      continue;
    }
    const Item item = std::move(waiting_.front());
    waiting_.pop_front();
    if (std::holds_alternative<GivenScan>(item)) --waiting_scans_;
    lock.unlock();
    work(item);
    lock.lock();
  }
  lock.unlock();
  if (journal_) journal_->sync();
}

void MappingDesk::read_earlier() {
  try {
    const std::uintmax_t whole = read_drive(
        options_.journal, {.on_odometry = [this](const OdometryReading& reading) { take(reading); },
                           .on_scan =
                               [this](const DriveScan& scan) {
                                 take({scan, last_ ? last_->odom_from_base : Transform2<Odom, Base>()});
                                 if (count_.scans % 20 == 0) tell(true);
                               }});
    journal_.emplace(options_.journal, whole);
  } catch (const std::exception& e) {
    count_.problem = e.what();
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
  const double step_m = last_scan_ ? way_m(*last_scan_, moved_to) : 0.0;
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
  const auto now = Clock::now();
  const double since_s = std::chrono::duration<double>(now - drawn_at_).count();
  const bool same = memory.size() == drawn_keyframes_ && memory.loops() == drawn_loops_;
  if (same || since_s < std::max(kPictureS, picture_cost_s_ / kPictureShare)) return;
  auto picture = std::make_shared<MappingPicture>(picture_of(mapper_.shown()));
  drawn_keyframes_ = memory.size();
  drawn_loops_ = memory.loops();
  drawn_at_ = Clock::now();
  picture_cost_s_ = std::chrono::duration<double>(drawn_at_ - now).count();
  const std::scoped_lock lock(mutex_);
  picture->revision = picture_->revision + 1;
  picture_ = std::move(picture);
}

}  // namespace madori::app
