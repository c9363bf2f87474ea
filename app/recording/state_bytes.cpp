#include "app/recording/state_bytes.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "core/result.hpp"

namespace madori::app {
namespace {

constexpr std::uint32_t kFormat = 23;

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
        if constexpr (requires { value.push_back(std::move(part)); })
          value.push_back(std::move(part));
        else
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

template <class Bytes, class... Fields>
void each(Bytes& bytes, Fields&... fields) {
  (bytes(fields), ...);
}

// Every field of a struct is named in a binding: one that is added does not compile until it is written too,
// or said to need no writing.

template <class Bytes, class Notice>
void each_of_notice(Bytes& bytes, Notice& n) {
  auto& [code, values, text] = n;
  static_cast<void>(values);  // for a panel in another language, which a replay has not
  each(bytes, code, text);
}

template <class Bytes, class Errand>
void each_of_errand(Bytes& bytes, Errand& e) {
  auto& [target, stop, nodes, doors, no_way, arrived, reported, dwell_until, back_outs, backing_held,
         blocked_legs] = e;
  each(bytes, target, stop, nodes, doors, arrived, reported, dwell_until, back_outs, backing_held,
       blocked_legs);
  each_of_notice(bytes, no_way);
}

template <class Bytes, class Way>
void each_of_way(Bytes& bytes, Way& w) {
  auto& [path, plain, rejoin_m, backing] = w;
  static_cast<void>(path);  // made from `plain`
  each(bytes, plain.points, rejoin_m, backing);
}

template <class Bytes, class Block>
void each_of_block(Bytes& bytes, Block& b) {
  auto& [felt, by_mover, unseen, height_unseen, doors_allowed, door_shut, squeeze, stirring, since,
         free_since] = b;
  each(bytes, felt, by_mover, unseen, height_unseen, doors_allowed, door_shut, squeeze, stirring, since,
       free_since);
}

template <class Bytes, class Search>
void each_of_search(Bytes& bytes, Search& d) {
  auto& [asked, id, pending, failed] = d;
  each(bytes, asked, id, pending, failed);
}

template <class Bytes, class Sight>
void each_of_sight(Bytes& bytes, Sight& s) {
  bytes(s.stamp), bytes(s.base_from_odom), bytes(s.view), bytes(s.nearest_m);
}

template <class Bytes, class State>
void each_of(Bytes& bytes, State& s) {
  auto& [mode, standstill, odometry, track, localization, site, pose, moved, sent, command_pose, obstacles,
         anchors, movers, drive, drive_heard, drive_clock, drive_us, drive_stopped, drive_faulty, drive_deaf,
         drive_late, lidars_heard, lidar_heard, previous, gap, begun, stopped, stopped_order,
         drawing_from_odom, elsewhere, jog, jog_heard, jog_held, errand, way, progress, ahead, block, detour,
         trail, trail_at, effort, limits, wheels, wheels_at, disobedient, unarmed_steps, mounting,
         lidars_missed, floor_unseen, bench] = s;
  static_cast<void>(bench);                                    // nothing in it lasts
  static_cast<void>(command_pose);                             // each step anew
  static_cast<void>(standstill), static_cast<void>(jog_held);  // for people, each step anew
  static_cast<void>(localization), static_cast<void>(site),
      static_cast<void>(pose);                              // a recording's own part
  static_cast<void>(obstacles), static_cast<void>(movers);  // below: they guard their fields
  bytes(sent.sent());
  each(bytes, mode, odometry, track, moved, anchors, drive, drive_heard, drive_clock, drive_us, drive_stopped,
       drive_faulty, drive_deaf, drive_late, lidars_heard, lidar_heard, previous, gap, begun, stopped,
       stopped_order, drawing_from_odom, elsewhere, jog, jog_heard, progress, ahead, trail, trail_at, effort,
       limits, wheels, wheels_at, disobedient, unarmed_steps, mounting, lidars_missed, floor_unseen);
  each_of_errand(bytes, errand);
  each_of_way(bytes, way);
  each_of_block(bytes, block);
  each_of_search(bytes, detour);
}

}  // namespace

std::string state_bytes(const CycleState& state) {
  BytesOut bytes;
  bytes(kFormat);
  each_of(bytes, state);
  bytes(state.obstacles.columns());
  bytes(static_cast<std::uint64_t>(state.obstacles.sights().sights().size()));
  for (const auto& sight : state.obstacles.sights().sights()) each_of_sight(bytes, sight);
  for (const MoverWatch& watch : state.movers) {
    bytes(watch.looked);
    bytes(static_cast<std::uint64_t>(watch.objects.tracks().size()));
    for (const auto& track : watch.objects.tracks())
      bytes(track.sightings), bytes(track.radius_m), bytes(track.high_m), bytes(track.since);
    bytes(watch.out_of_sight.walkers()), bytes(watch.out_of_sight.points());
  }
  return bytes.take();
}

namespace {

void restore_watch(BytesIn& bytes, MoverWatch& watch, std::size_t most) {
  std::uint64_t count = 0;
  bytes(watch.looked), bytes(count);
  std::vector<planning::MovingObjects::Track> tracks;
  for (std::uint64_t i = 0; i < count && i < most; ++i) {
    auto& track = tracks.emplace_back();
    bytes(track.sightings), bytes(track.radius_m), bytes(track.high_m), bytes(track.since);
  }
  watch.objects.restore(std::move(tracks));
  std::vector<planning::LostMover> walkers;
  std::vector<Point2<Odom>> points;
  bytes(walkers), bytes(points);
  watch.out_of_sight.restore(std::move(walkers), std::move(points));
}

}  // namespace

void restore_state(CycleState& state, const std::string& text, const CycleConfig& config) {
  BytesIn bytes(text);
  std::uint32_t format = 0;
  bytes(format);
  if (format != kFormat) BytesIn::fail();
  each_of(bytes, state);
  std::vector<planning::Column> columns;
  bytes(columns);
  std::uint64_t count = 0;
  bytes(count);
  Ring<planning::SightHistory::Sight> sights;
  for (std::uint64_t i = 0; i < count && i < text.size(); ++i) each_of_sight(bytes, sights.add());
  state.obstacles.restore(std::move(columns), std::move(sights));
  for (MoverWatch& watch : state.movers) restore_watch(bytes, watch, text.size());
  if (!bytes.at_end()) BytesIn::fail();
  const Path& path = state.way.plain;
  state.way.path =
      path.points.empty() ? control::TrackedPath() : control::TrackedPath(path, config.pursuit.speed);
}

}  // namespace madori::app
