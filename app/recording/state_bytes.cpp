#include "app/recording/state_bytes.hpp"

#include <cstdint>
#include <cstring>
#include <deque>
#include <type_traits>

#include "core/result.hpp"

namespace madori::app {
namespace {

constexpr std::uint32_t kFormat = 7;

template <class T>
inline constexpr bool kPlain = std::is_trivially_copyable_v<T>;

class BytesOut {
 public:
  template <class T>
  void operator()(const T& value) {
    if constexpr (kPlain<T>) {
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else if constexpr (requires { value.has_value(); }) {
      (*this)(value.has_value());
      if (value) (*this)(*value);
    } else if constexpr (requires { value.first; }) {
      (*this)(value.first);
      (*this)(value.second);
    } else {
      (*this)(static_cast<std::uint64_t>(value.size()));
      for (const auto& part : value) (*this)(part);
    }
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class BytesIn {
 public:
  explicit BytesIn(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(T& value) {
    if constexpr (kPlain<T>) {
      if (bytes_.size() - at_ < sizeof value) fail();
      std::memcpy(static_cast<void*>(&value), bytes_.data() + at_, sizeof value);
      at_ += sizeof value;
    } else if constexpr (requires { value.has_value(); }) {
      bool there = false;
      (*this)(there);
      value.reset();
      if (there) (*this)(value.emplace());
    } else if constexpr (requires { value.first; }) {
      (*this)(value.first);
      (*this)(value.second);
    } else {
      std::uint64_t count = 0;
      (*this)(count);
      if (count > bytes_.size()) fail();
      value.clear();
      for (std::uint64_t i = 0; i < count; ++i) {
        std::remove_reference_t<decltype(*value.begin())> part{};
        (*this)(part);
        value.insert(value.end(), std::move(part));
      }
    }
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[noreturn]] static void fail() {
    throw Error("recording", "was begun by another Madori", "replay it with the one that recorded it");
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template <class Bytes, class Way>
void each_of_way(Bytes& bytes, Way& w) {
  bytes(w.target), bytes(w.stop), bytes(w.nodes), bytes(w.plain.points), bytes(w.pursuit), bytes(w.status);
  bytes(w.along_m), bytes(w.cross_track_m), bytes(w.arrived), bytes(w.reported), bytes(w.dwell_until);
  bytes(w.rejoin_m), bytes(w.check), bytes(w.stop_along_m), bytes(w.care_along_m), bytes(w.turn_free);
  bytes(w.held), bytes(w.held_since), bytes(w.felt);
  bytes(w.backing), bytes(w.backing_held), bytes(w.back_outs);
  bytes(w.squeeze.share), bytes(w.squeeze.wall_slack_m), bytes(w.by_mover), bytes(w.unseen),
      bytes(w.height_unseen), bytes(w.doors_allowed), bytes(w.stirring), bytes(w.blocked_since),
      bytes(w.free_since), bytes(w.asked_detour);
  bytes(w.detour_id), bytes(w.detour_pending), bytes(w.detour_failed), bytes(w.blocked_legs);
}

template <class Bytes, class Sight>
void each_of_sight(Bytes& bytes, Sight& s) {
  bytes(s.stamp), bytes(s.base_from_odom), bytes(s.view), bytes(s.nearest_m);
}

template <class Bytes, class State>
void each_of(Bytes& bytes, State& s) {
  bytes(s.mode), bytes(s.odometry), bytes(s.track), bytes(s.drive), bytes(s.drive_heard),
      bytes(s.drive_clock), bytes(s.drive_us), bytes(s.lidars_heard), bytes(s.lidar_heard), bytes(s.looked);
  bytes(s.previous), bytes(s.gap), bytes(s.protective_stop), bytes(s.jog), bytes(s.jog_heard),
      bytes(s.limits);
  bytes(s.unarmed_steps), bytes(s.effort), bytes(s.trail), bytes(s.trail_at);
  each_of_way(bytes, s.way);
}

}  // namespace

std::string state_bytes(const CycleState& state) {
  BytesOut bytes;
  bytes(kFormat);
  each_of(bytes, state);
  bytes(state.way.no_way.code), bytes(state.way.no_way.text);
  bytes(state.obstacles.columns());
  bytes(static_cast<std::uint64_t>(state.obstacles.sights().sights().size()));
  for (const auto& sight : state.obstacles.sights().sights()) each_of_sight(bytes, sight);
  bytes(static_cast<std::uint64_t>(state.movers.tracks().size()));
  for (const auto& track : state.movers.tracks()) bytes(track.sightings), bytes(track.radius_m);
  return bytes.take();
}

void restore_state(CycleState& state, const std::string& text, const CycleConfig& config) {
  BytesIn bytes(text);
  std::uint32_t format = 0;
  bytes(format);
  if (format != kFormat) BytesIn::fail();
  each_of(bytes, state);
  bytes(state.way.no_way.code), bytes(state.way.no_way.text);
  std::vector<planning::Column> columns;
  bytes(columns);
  std::uint64_t count = 0;
  bytes(count);
  std::deque<planning::SightHistory::Sight> sights;
  for (std::uint64_t i = 0; i < count && i < text.size(); ++i) each_of_sight(bytes, sights.emplace_back());
  state.obstacles.restore(std::move(columns), std::move(sights));
  bytes(count);
  std::vector<planning::MovingObjects::Track> tracks;
  for (std::uint64_t i = 0; i < count && i < text.size(); ++i) {
    auto& track = tracks.emplace_back();
    bytes(track.sightings), bytes(track.radius_m);
  }
  state.movers.restore(std::move(tracks));
  if (!bytes.at_end()) BytesIn::fail();
  const Path& path = state.way.plain;
  state.way.path =
      path.points.empty() ? control::TrackedPath() : control::TrackedPath(path, config.pursuit.speed);
}

}  // namespace madori::app
