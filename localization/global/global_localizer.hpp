#pragma once

#include <optional>
#include <vector>

#include "localization/global/evidence.hpp"
#include "localization/global/global_answer.hpp"
#include "localization/global/place_index.hpp"

namespace madori::localization {

/// Kidnapped robot: Algorithm 2 of Kis, Csemesz, Csáji (2021), and further. All places and turns are compared
/// by their precomputed views at once; the likeliest are weighed by the likelihood field, registered, and
/// judged by the whole scan: points on walls speak for a pose, beams through walls against it. How close is
/// close follows the scan's own noise.
class GlobalLocalizer {
 public:
  /// Prepares the tables of `walls` (seconds for a large site); `index` is taken when it was saved for them.
  explicit GlobalLocalizer(const mapping::Walls& walls, std::optional<PlaceIndex> index = std::nullopt);

  /// From one scan alone.
  [[nodiscard]] GlobalAnswer locate(const ScanPoints& points) const;
  /// Carries `before` along by the odometry since and judges it by one more scan, beside fresh candidates.
  /// What one scan leaves ambiguous, a few resolve.
  [[nodiscard]] GlobalAnswer locate(const ScanPoints& points, const GlobalAnswer& before,
                                    const Transform2<Base, Base>& moved) const;
  /// Registers and judges given poses only.
  [[nodiscard]] GlobalAnswer judge(const ScanPoints& points,
                                   const std::vector<Transform2<Map, Base>>& poses) const;

  /// By how many nats the best of the poses within 2 m and 12 degrees explains the points better, coarsely:
  /// near zero where the pose is right (0.2 ms).
  [[nodiscard]] double lead_of_nearby(const ScanPoints& points,
                                      const Transform2<Map, Base>& map_from_base) const;

  [[nodiscard]] const PlaceIndex& index() const { return index_; }
  [[nodiscard]] const SegmentGrid& grid() const { return tables_.grid; }
  [[nodiscard]] const LikelihoodField& field() const { return tables_.fine; }
  [[nodiscard]] const mapping::DistanceField& distance_field() const { return tables_.distance; }

 private:
  [[nodiscard]] std::vector<Transform2<Map, Base>> candidates(const ScanPoints& points) const;

  WallTables tables_;
  PlaceIndex index_;
};

}  // namespace madori::localization
