#include "localization/memory/thinning.hpp"

#include <algorithm>
#include <cmath>

#include "localization/memory/fuse.hpp"

namespace madori::localization {
namespace {

/// Enough of the newer poses that stay are of the same place and look the same way.
bool is_crowded(std::size_t k, const std::vector<Transform2<Map, Base>>& poses, const std::vector<char>& gone,
                const MemoryOptions& options) {
  int beside = 0;
  for (std::size_t i = k + 1; i < poses.size() && beside < options.keyframes_a_place; ++i) {
    beside += gone[i] == 0 && distance_m(poses[i].translation(), poses[k].translation()) < options.place_m &&
                      std::abs(wrap_angle(poses[i].yaw_rad() - poses[k].yaw_rad())) < options.place_rad
                  ? 1
                  : 0;
  }
  return beside >= options.keyframes_a_place;
}

}  // namespace

std::vector<char> thin_out(const std::vector<Transform2<Map, Base>>& poses,
                           std::vector<RelativeFactor>& factors, std::size_t end,
                           const MemoryOptions& options) {
  std::vector<char> gone(poses.size(), 0);
  for (std::size_t k = 1; k < end; ++k) {
    if (is_crowded(k, poses, gone, options) && take_out(static_cast<int>(k), poses, factors)) gone[k] = 1;
  }
  return gone;
}

void compact(const std::vector<char>& gone, std::vector<Keyframe>& keyframes,
             std::vector<Transform2<Map, Base>>& poses, std::vector<RelativeFactor>& factors) {
  std::vector<int> number(gone.size(), 0);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < gone.size(); ++k) {
    number[k] = static_cast<int>(kept);
    if (gone[k] != 0) continue;
    keyframes[kept] = keyframes[k];
    poses[kept] = poses[k];
    ++kept;
  }
  keyframes.resize(kept);
  poses.resize(kept);
  for (RelativeFactor& f : factors) {
    f.from = number[static_cast<std::size_t>(f.from)];
    f.to = number[static_cast<std::size_t>(f.to)];
  }
}

}  // namespace madori::localization
