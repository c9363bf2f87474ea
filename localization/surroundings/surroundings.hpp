#pragma once

#include <optional>

#include "localization/surroundings/recent_view.hpp"

namespace madori::localization {

/// Beside the scan before.
enum class Surroundings { Same, Others };

/// Was the vehicle carried off between two scans? Learns what is usual, needs no drawing. Deterministic,
/// causal.
class SurroundingsCheck {
 public:
  /// Other surroundings: what is usual is learned anew.
  void restart() { view_ = {}; }
  /// A scan, Base frame at `stamp`; the one before it becomes the one that it is compared with.
  void take(Stamp stamp, const ScanPoints& points);
  /// Compares the two, the later one laid where the wheels or where the walls say that it was taken.
  [[nodiscard]] Surroundings compare(const Transform2<Base, Base>& by_wheels,
                                     const Transform2<Base, Base>& by_walls);
  /// The two followed so closely that nothing else changes what is seen by as much as a carry does.
  [[nodiscard]] bool followed_at_once() const { return gap_s_ < kAtOnce_s; }

 private:
  /// Lidars that look less often, and revolutions lost by a busy computer, need the memory's word as well.
  static constexpr double kAtOnce_s = 0.15;

  RecentView view_;
  std::optional<Stamp> newest_;
  double gap_s_ = 1e9;
};

}  // namespace madori::localization
