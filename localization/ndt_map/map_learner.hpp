#pragma once

#include <cstddef>
#include <utility>

#include "core/pose_estimate.hpp"
#include "localization/ndt_map/hybrid_map.hpp"

namespace madori::localization {

/// Decides which scans of a drive enter the living map: those whose place is sure to half a cell, five a
/// second.
class MapLearner {
 public:
  explicit MapLearner(HybridMap begun) : map_(std::move(begun)) {}

  /// Whether the place is known so well that what is seen from there does not blur the map.
  [[nodiscard]] static bool is_sure(const PoseEstimate& pose);
  /// Whether it is long enough after the last look, or before it: a clock was set back.
  [[nodiscard]] static bool is_later(Stamp last, Stamp stamp);
  /// Whether a scan at that pose shall be handed to look().
  [[nodiscard]] bool is_due(const PoseEstimate& pose) const {
    return is_sure(pose) && (looks_ == 0 || is_later(last_, pose.stamp));
  }
  void look(const Beams& beams, const PoseEstimate& pose);
  [[nodiscard]] const HybridMap& map() const { return map_; }
  [[nodiscard]] std::size_t looks() const { return looks_; }

 private:
  HybridMap map_;
  Stamp last_{};
  std::size_t looks_ = 0;
};

}  // namespace madori::localization
