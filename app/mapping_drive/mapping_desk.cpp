#include "app/mapping_drive/mapping_desk.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/thread_role.hpp"
#include "localization/localizer/options.hpp"

namespace madori::app {
namespace {

constexpr std::size_t kMostWaitingScans = 20;  ///< two seconds of a lidar that turns at 10 Hz
constexpr std::size_t kMostWaiting = 2000;     ///< readings of the wheels with them
constexpr double kStepM = 0.04;                ///< between two scans that the mapper gets,
constexpr double kStepRad = 0.0175;            ///< or this much turning
constexpr auto kPicturePause = std::chrono::seconds(1);

double way_m(const Transform2<Odom, Base>& from, const Transform2<Odom, Base>& to) {
  return distance_m(from.translation(), to.translation());
}

bool moved(const Transform2<Odom, Base>& from, const Transform2<Odom, Base>& to) {
  return way_m(from, to) > kStepM || std::abs(wrap_angle(to.yaw_rad() - from.yaw_rad())) > kStepRad;
}

}  // namespace

MappingDesk::MappingDesk(Options options)
    : options_(std::move(options)), mapper_(localization::driving_options()) {
  told_.reading = true;
  if (options_.beside)
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  else
    read_earlier({});
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
  read_earlier(stop);
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

}  // namespace madori::app
