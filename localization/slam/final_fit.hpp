#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "localization/memory/memory.hpp"
#include "localization/slam/mapper.hpp"

namespace madori::localization {

/// The memory, every keyframe laid on each of its partners and the graph of all these motions solved, a few
/// times over: after the loops are closed the map still has the shape that the drive's motions gave it, since
/// only one keyframe in many was tied to an older one.
[[nodiscard]] Memory final_fit(const Memory& memory, const MemoryOptions& memory_options);

/// Lays the scans between the keyframes on the finished map. `scans[i]` stands at about `poses[i]`; keyframe
/// k is scan `scan_of[k]`.
void fit_scans(const Memory& memory, const std::vector<std::size_t>& scan_of,
               const std::vector<std::shared_ptr<const SurfaceScan>>& scans, std::vector<MomentPose>& poses);

/// The last look where the points are so noisy (`noise_m`, sigma) that the point nearest to another one tells
/// little of a surface: all scans bundled by the surfaces that they saw together (surface_bundle), held to
/// one another by what they are laid at, to the noise. The memory with its keyframes where their scans are.
[[nodiscard]] Memory bundle_noisy(const Memory& memory, const std::vector<std::size_t>& scan_of,
                                  const std::vector<std::shared_ptr<const SurfaceScan>>& scans,
                                  double noise_m, const MemoryOptions& memory_options,
                                  std::vector<MomentPose>& poses);

}  // namespace madori::localization
