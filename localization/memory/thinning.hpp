#pragma once

#include <cstddef>
#include <vector>

#include "localization/memory/keyframe.hpp"
#include "localization/memory/memory_options.hpp"
#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// Takes keyframes before `end` out of the graph where others that stay saw the same place, and says for each
/// whether it is gone (1) or stays (0). The first stays: the start pose is tied to it. Keyframes keep their
/// numbers until compact().
[[nodiscard]] std::vector<char> thin_out(const std::vector<Keyframe>& keyframes,
                                         const std::vector<Transform2<Map, Base>>& poses,
                                         std::vector<RelativeFactor>& factors, std::size_t end,
                                         const MemoryOptions& options);

/// Closes the gaps: the keyframes and poses that stay move up, in order, and the factors follow their
/// numbers. No factor may touch one that is gone.
void compact(const std::vector<char>& gone, std::vector<Keyframe>& keyframes,
             std::vector<Transform2<Map, Base>>& poses, std::vector<RelativeFactor>& factors);

}  // namespace madori::localization
