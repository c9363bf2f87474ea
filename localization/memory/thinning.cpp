#include "localization/memory/thinning.hpp"

#include "localization/memory/fuse.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {

/// Only what stays covers a place: a keyframe is taken out for one that survives, never for one that is about
/// to be taken out itself. Of one visit the first at a place stays, else each new one would erase its
/// forerunner; of two visits the newer one stays.
std::vector<char> thin_out(const std::vector<Keyframe>& keyframes,
                           const std::vector<Transform2<Map, Base>>& poses,
                           std::vector<RelativeFactor>& factors, std::size_t end,
                           const MemoryOptions& options) {
  std::vector<char> gone(poses.size(), 0);
  const auto leave = [&](std::size_t k) {
    if (take_out(static_cast<int>(k), poses, factors)) gone[k] = 1;
  };
  for (std::size_t k = 1; k < end; ++k) {
    std::vector<std::size_t> older;
    bool covered = false;
    for (std::size_t i = 0; i < k && !covered; ++i) {
      if (gone[i] != 0 || !same_place(poses[i], poses[k], options.place_m, options.place_rad)) continue;
      covered = keyframes[k].path_m - keyframes[i].path_m < options.window_path_m;
      if (i > 0) older.push_back(i);  // the first stays: the start pose is tied to it
    }
    if (covered) {
      leave(k);
    } else {
      for (const std::size_t i : older) leave(i);
    }
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
