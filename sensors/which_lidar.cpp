#include "sensors/which_lidar.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

namespace madori::sensors {
namespace {

/// The only lidar of which this is true; null where there are several, or none.
template <class Test>
const MountedLidar* only_one(const std::vector<MountedLidar>& lidars, Test test) {
  const auto first = std::ranges::find_if(lidars, test);
  if (first == lidars.end() || std::any_of(first + 1, lidars.end(), test)) return nullptr;
  return &*first;
}

/// Our recordings number the scans by their lidar's place: /scan, /scan/1 ...
std::optional<std::size_t> place_by(const std::string& topic) {
  const std::string first = "/scan";
  if (topic == first) return 0;
  std::size_t place = 0;
  const char* const end = topic.data() + topic.size();
  if (!topic.starts_with(first + "/")) return std::nullopt;
  const auto [stop, error] = std::from_chars(topic.data() + first.size() + 1, end, place);
  return error == std::errc() && stop == end ? std::optional(place) : std::nullopt;
}

}  // namespace

const MountedLidar* which_lidar(const std::vector<MountedLidar>& lidars, bool planar,
                                const std::string& topic, std::string frame) {
  if (frame.starts_with('/')) frame.erase(0, 1);
  const auto* const named = only_one(lidars, [&](const MountedLidar& l) { return l.frame == frame; });
  if (named != nullptr) return named;
  if (const auto place = place_by(topic)) {
    const auto counts = [&](const MountedLidar& l) { return l.planar && l.place == *place; };
    const auto* const counted = planar ? only_one(lidars, counts) : nullptr;
    if (counted != nullptr) return counted;
  }
  const auto* const kind = only_one(lidars, [&](const MountedLidar& l) { return l.planar == planar; });
  return kind != nullptr ? kind : only_one(lidars, [](const MountedLidar&) { return true; });
}

std::string names_of(const std::vector<MountedLidar>& lidars) {
  std::string names;
  for (const MountedLidar& lidar : lidars) names += (names.empty() ? "" : ", ") + lidar.name;
  return names;
}

}  // namespace madori::sensors
