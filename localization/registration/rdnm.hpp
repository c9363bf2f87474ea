#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/transform2.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct RdnOptions {
  int sections = 72;       ///< alpha = 2 pi / sections
  double epsilon_m = 0.5;  ///< depth of the nearest surface within a section
  double unlike_m = 1.0;  ///< a section's difference counts no more than this (the paper's norm is unbounded)
};

/// Relative directional neighbours: for each section of directions around a viewpoint, the mean distance of
/// the nearest surface; kEmptySection where there is none.
using RdnDescriptor = std::vector<float>;
inline constexpr float kEmptySection = -1.0F;

/// Algorithm 1, procedure RDN, of Kis, Csemesz, Csáji (2021): the points of each section between its nearest
/// distance and epsilon beyond it, averaged. Section i holds the directions [i, i + 1) * alpha, by the
/// two-argument arctangent. The paper leaves open what an empty section is worth; here it is marked, and left
/// out of every comparison.
template <class F>
[[nodiscard]] RdnDescriptor rdn(std::span<const Point2<F>> points, const Point2<F>& viewpoint,
                                const RdnOptions& options);
[[nodiscard]] RdnDescriptor rdn(const ScanPoints& points, const RdnOptions& options);

/// Mean difference of two descriptors, the second seen turned: section i of `scan` beside section i + shift
/// of `map`. Over the sections that neither leaves empty; unlike_m when these are fewer than a quarter.
[[nodiscard]] double rdn_difference(const RdnDescriptor& scan, const RdnDescriptor& map, int shift,
                                    double unlike_m);

struct RdnmResult {
  Transform2<Map, Base> map_from_base;  ///< R(shift * alpha) x + p: the shift is taken times alpha
  double difference_m = 0.0;
};

/// Algorithm 1, procedure RDNM: the candidate position and the turn (a multiple of alpha) whose view of the
/// map is most like the scan. Nothing when there are no candidates or no points.
[[nodiscard]] std::optional<RdnmResult> rdnm(const ScanPoints& scan, std::span<const Point2<Map>> map,
                                             std::span<const Point2<Map>> candidates,
                                             const RdnOptions& options = {});

}  // namespace madori::localization
