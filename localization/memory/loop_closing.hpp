#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "localization/memory/keyframe.hpp"
#include "localization/memory/memory_options.hpp"
#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// Old keyframes that a newer one may be tied to: a stretch of the chain, and the one of it that is nearest.
struct LoopCandidate {
  std::size_t nearest;
  std::size_t first;
  std::size_t last;   ///< of the stretch, inclusive
  double distance_m;  ///< to the nearest, a radian of turn counting as a metre
};

/// Among the keyframes before `end`, the two best stretches near keyframe `newest`: one candidate a stay in
/// the neighbourhood.
[[nodiscard]] std::vector<LoopCandidate> loop_candidates(const std::vector<Transform2<Map, Base>>& poses,
                                                         std::size_t newest, std::size_t end,
                                                         const MemoryOptions& options);

/// Matches the scan of keyframe `newest` against the candidate's surfaces, in a window that grows with the
/// driving `open_m` (metres) since a loop was closed. The factor from the nearest old keyframe to the newest,
/// or nothing where the scan does not fit well enough. `poses` has one a keyframe.
[[nodiscard]] std::optional<RelativeFactor> match_loop(const std::vector<Keyframe>& keyframes,
                                                       const std::vector<Transform2<Map, Base>>& poses,
                                                       std::size_t newest, const LoopCandidate& candidate,
                                                       double open_m, const MemoryOptions& options);

/// Nats by which the loops among `factors` that span `first` speak against moving the poses from `first` on
/// (Cauchy, as in the graph).
[[nodiscard]] double loops_against(const std::vector<RelativeFactor>& factors,
                                   const std::vector<Transform2<Map, Base>>& poses,
                                   const Transform2<Map, Map>& by, std::size_t first);

}  // namespace madori::localization
