#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "localization/memory/memory.hpp"
#include "localization/slam/mapper.hpp"

namespace madori::localization {

/// The last look at all of a drive. Lengths in metres; a radian of turn counts as `radian_m` of distance.
struct FinalFitOptions {
  double near_m = 5.0;  ///< keyframes this near to each other may have seen the same surfaces
  double radian_m = 0.7;
  std::size_t partners = 20;        ///< of a keyframe at most, from near to far
  double inlier_share = 0.4;        ///< of a keyframe that must lie on what its partner saw
  double chain_information = 0.05;  ///< what the motions of the drive count where partners hold a keyframe
  double loop_loss = 1.0;           ///< sigmas; beyond, a tie pulls less and less (Cauchy)
  int rounds = 3;
  double map_near_m = 4.0;  ///< keyframes this near make the piece of map that a scan is laid on
  double map_radian_m = 1.0;
  std::size_t map_keyframes = 15;
  double scan_sigma_m = 0.05;  ///< of a scan's pose between its keyframes
  double scan_sigma_rad = 0.016;
};

/// The memory, every keyframe laid on each of its partners and the graph of all these motions solved, a few
/// times over: after the loops are closed the map still has the shape that the drive's motions gave it, since
/// only one keyframe in many was tied to an older one.
[[nodiscard]] Memory final_fit(const Memory& memory, const MemoryOptions& memory_options,
                               const FinalFitOptions& options = {});

/// Lays the scans between the keyframes on the finished map. `scans[i]` stands at about `poses[i]`; keyframe
/// k is scan `scan_of[k]`.
void fit_scans(const Memory& memory, const std::vector<std::size_t>& scan_of,
               const std::vector<std::shared_ptr<const SurfaceScan>>& scans, std::vector<MomentPose>& poses,
               const FinalFitOptions& options = {});

/// The last look where the points are so noisy (`noise_m`, sigma) that the point nearest to another one tells
/// little of a surface: all scans bundled by the surfaces that they saw together (surface_bundle), held to
/// one another by what they are laid at, to the noise. The memory with its keyframes where their scans are.
[[nodiscard]] Memory bundle_noisy(const Memory& memory, const std::vector<std::size_t>& scan_of,
                                  const std::vector<std::shared_ptr<const SurfaceScan>>& scans,
                                  double noise_m, const MemoryOptions& memory_options,
                                  std::vector<MomentPose>& poses);

}  // namespace madori::localization
