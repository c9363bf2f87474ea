#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/transform2.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// How two descriptors are compared: by the Euclidean norm of the paper (divided by the root of the number of
/// sections compared), or by the mean difference of which a section counts no more than `unlike_m`.
enum class RdnNorm { Published, CappedMean };

struct RdnOptions {
  int sections = 72;       ///< alpha = 2 pi / sections
  double epsilon_m = 0.5;  ///< depth of the nearest surface within a section
  RdnNorm norm = RdnNorm::Published;
  double unlike_m = 1.0;
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

/// Difference of two descriptors, the second seen turned: section i of `scan` beside section i + shift of
/// `map`. Over the sections that neither leaves empty; infinite when these are fewer than a quarter.
[[nodiscard]] double rdn_difference(const RdnDescriptor& scan, const RdnDescriptor& map, int shift,
                                    const RdnOptions& options = {});

struct RdnmResult {
  Transform2<Map, Base> map_from_base;  ///< R(shift * alpha) x + p: the shift is taken times alpha
  double difference_m = 0.0;
};

/// Only turns within `most_rad` of the heading are looked at.
struct TurnLimit {
  double heading_rad = 0.0;
  double most_rad = kPi;
};
/// Of every candidate position the turns that are more like the scan than those beside them, the most like it
/// first: a corridor looks the same both ways, and from half a metre beside the right place the wrong way may
/// look more like it. The paper keeps the best turn alone. A view that has too little in common with the
/// scan is left out.
[[nodiscard]] std::vector<RdnmResult> rdnm_ranked(const ScanPoints& scan, std::span<const Point2<Map>> map,
                                                  std::span<const Point2<Map>> candidates,
                                                  const RdnOptions& options = {},
                                                  const TurnLimit& turns = {});
/// The same with what is seen of the map from every candidate.
[[nodiscard]] std::vector<RdnmResult> rdnm_ranked(const ScanPoints& scan,
                                                  std::span<const Point2<Map>> candidates,
                                                  std::span<const RdnDescriptor> views,
                                                  const RdnOptions& options = {},
                                                  const TurnLimit& turns = {});

/// Algorithm 1, procedure RDNM: the candidate position and the turn (a multiple of alpha) whose view of the
/// map is most like the scan. Nothing when there are no candidates or no points.
[[nodiscard]] std::optional<RdnmResult> rdnm(const ScanPoints& scan, std::span<const Point2<Map>> map,
                                             std::span<const Point2<Map>> candidates,
                                             const RdnOptions& options = {}, const TurnLimit& turns = {});

}  // namespace madori::localization
