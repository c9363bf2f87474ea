#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "localization/drawing_fit/drawing_model.hpp"
#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"

namespace madori::localization {

/// Where the memory lies on the drawing: what to move it by, and how much better that is (nats of likelihood;
/// the pieces of one wall count as one for two metres).
struct Alignment {
  Transform2<Map, Map> correction;
  double gain = 0.0;        ///< over leaving it where it is
  double likelihood = 0.0;  ///< at the correction
};

/// Window of the search around where the memory lies now, turning about the memory's own centre.
struct AlignmentWindow {
  double half_m = 1.2;
  double half_rad = 0.35;
  std::size_t sample = 500;  ///< surfaces that are looked at on the grid

  [[nodiscard]] bool contains(const Transform2<Map, Map>& correction, const Point2<Map>& centre) const {
    const Point2<Map> moved = correction * centre;
    return std::abs(moved.x_m - centre.x_m) <= half_m && std::abs(moved.y_m - centre.y_m) <= half_m &&
           std::abs(correction.yaw_rad()) <= half_rad;
  }
};

/// Of the surfaces by weight, Map frame.
[[nodiscard]] Point2<Map> centre_of(const MemoryCloud& cloud);

/// Nats by which the drawing explains the cloud after `correction`, over clutter.
[[nodiscard]] double log_likelihood(const WallIndex& index, const MemoryCloud& cloud,
                                    const Transform2<Map, Map>& correction, const WallMixture& mixture);

/// The best few corrections on a grid over the window, by the tables of distances alone. No fewer than one.
[[nodiscard]] std::vector<Transform2<Map, Map>> coarse_alignments(const WallIndex& index,
                                                                  const MemoryCloud& cloud,
                                                                  const Point2<Map>& centre,
                                                                  const AlignmentWindow& window);

inline constexpr double kCatchSigmaM = 0.35;  ///< from so far a wall draws what belongs to it

/// Gauss-Newton on the distances to the walls from one start, the mixture narrowing down to the model's sigma
/// (iteratively reweighted: a surface counts as far as it is likely to be a wall). A small first sigma stays
/// at the optimum that the start is at.
[[nodiscard]] Transform2<Map, Map> refine_alignment(const WallIndex& index, const MemoryCloud& cloud,
                                                    const Point2<Map>& centre,
                                                    Transform2<Map, Map> correction,
                                                    const DrawingModel& model,
                                                    double first_sigma_m = kCatchSigmaM);

}  // namespace madori::localization
