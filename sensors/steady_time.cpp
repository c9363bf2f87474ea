#include "sensors/steady_time.hpp"

#include <algorithm>

#include "core/median.hpp"

namespace madori::sensors {
namespace {

constexpr int kRunOn = 5;  ///< late records of a kind, none in time between them: its clock was set
constexpr std::size_t kSteps = 15;
constexpr Duration kSoon = std::chrono::seconds(1);
constexpr std::size_t kMostHeld = 200;  ///< a kind that ends in a late record is waited for no longer

std::string kind_of(const LogRecord& record) {
  if (const auto* scan = std::get_if<ScanRecord>(&record)) return "scans of " + scan->source;
  if (const auto* cloud = std::get_if<CloudRecord>(&record)) return "clouds of " + cloud->source;
  return "odometry";
}

void move_stamp(LogRecord& record, Duration by) {
  if (auto* scan = std::get_if<ScanRecord>(&record))
    scan->scan.stamp += by;
  else if (auto* cloud = std::get_if<CloudRecord>(&record))
    cloud->cloud.stamp += by;
  else
    std::get<OdometryReading>(record).stamp += by;
}

}  // namespace

Duration SteadyTimeReader::Kind::usual_step() const {
  std::deque<Duration> some = steps;
  return some.empty() ? Duration(0) : median_of(some);
}

/// Whether its late records follow the others, and soon, where their clock was set back by so much.
bool SteadyTimeReader::Kind::goes_on_where_moved(Duration by) const {
  if (!doubt || doubt->first + by < *newest) return false;
  return doubt->first + by - *newest <= std::max<Duration>(10 * usual_step(), kSoon);
}

void SteadyTimeReader::Kind::take(Stamp stamp) {
  if (newest) steps.push_back(stamp - *newest);
  if (steps.size() > kSteps) steps.pop_front();
  newest = stamp;
}

std::optional<LogRecord> SteadyTimeReader::next() {
  while (!ended_ && (held_.empty() || (in_doubt() && held_.size() < kMostHeld))) {
    std::optional<LogRecord> record = source_->next();
    if (record)
      take(std::move(*record));
    else
      ended_ = true;
  }
  if (held_.empty()) return std::nullopt;
  LogRecord first = std::move(held_.front().record);
  held_.pop_front();
  return first;
}

bool SteadyTimeReader::in_doubt() const {
  return std::ranges::any_of(held_, [](const Held& held) { return held.doubted != nullptr; });
}

void SteadyTimeReader::take(LogRecord record) {
  Kind& kind = kinds_[kind_of(record)];
  move_stamp(record, kind.moved);
  const Stamp stamp = stamp_of(record);
  if (kind.newest && stamp < *kind.newest) return doubt(kind, std::move(record));
  for (Held& held : held_)
    if (held.doubted == &kind) held.doubted = nullptr;
  kind.doubt.reset();
  kind.sets = sets_;
  kind.take(stamp);
  held_.push_back({std::move(record), nullptr});
}

void SteadyTimeReader::doubt(Kind& kind, LogRecord record) {
  const Stamp stamp = stamp_of(record);
  if (kind.doubt && stamp >= kind.doubt->last) {
    kind.doubt->last = stamp;
    ++kind.doubt->records;
  } else {
    kind.doubt = Doubt{stamp, stamp};
  }
  held_.push_back({std::move(record), &kind});
  if (kind.sets < sets_ && kind.goes_on_where_moved(last_set_))
    move(kind, last_set_);  // it was set with another kind, and tells of it later
  else if (kind.doubt->records >= kRunOn && kind.doubt->first < kind.doubt->last)
    believe(kind);
}

void SteadyTimeReader::believe(const Kind& set) {
  last_set_ = *set.newest + set.usual_step() - set.doubt->first;
  ++sets_;
  for (auto& [name, kind] : kinds_) {
    if (!kind.goes_on_where_moved(last_set_)) continue;
    if (&kind == &set && remark_ && sets_ == 1)
      remark_("the clock of the " + name + " was set back: the times that follow are moved on by " +
              std::to_string(to_seconds(last_set_)) + " s");
    move(kind, last_set_);
  }
}

/// Its late records, and all that follow.
void SteadyTimeReader::move(Kind& kind, Duration by) {
  kind.moved += by;
  kind.sets = sets_;
  for (Held& held : held_) {
    if (held.doubted != &kind) continue;
    move_stamp(held.record, by);
    if (stamp_of(held.record) >= *kind.newest) kind.take(stamp_of(held.record));
    held.doubted = nullptr;
  }
  kind.doubt.reset();
}

}  // namespace madori::sensors
