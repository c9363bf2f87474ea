#pragma once

#include <optional>

#include "localization/surroundings/recent_view.hpp"

namespace madori::localization {

struct SurroundingsOptions {
  /// What two scans in a row both see falls by so much below the usual where the later one was taken
  /// elsewhere: neither driving nor what moves about changes a quarter of the walls in a tenth of a second.
  double carried_fall = 0.25;
  double wheels_fall = 0.08;  ///< from here on the wheels may be wrong: the walls are asked as well
  /// Lidars that look less often, and revolutions lost by a busy computer, need the memory's word as well.
  double at_once_s = 0.15;
};

/// Beside the scan before.
enum class Surroundings { Same, Others };

/// Was the vehicle carried off between two scans? Learns what is usual, needs no drawing. Deterministic,
/// causal.
class SurroundingsCheck {
 public:
  explicit SurroundingsCheck(const SurroundingsOptions& options) : options_(options) {}

  /// Other surroundings: what is usual is learned anew.
  void restart() { view_ = {}; }
  /// A scan, Base frame at `stamp`; the one before it becomes the one that it is compared with.
  void take(Stamp stamp, const ScanPoints& points);
  /// Compares the two, the later one laid where the wheels or where the walls say that it was taken.
  [[nodiscard]] Surroundings compare(const Transform2<Base, Base>& by_wheels,
                                     const Transform2<Base, Base>& by_walls);
  /// Share of the surfaces, 0..1, that both scans saw as they were compared; 1 until then.
  [[nodiscard]] double kept() const { return kept_; }
  /// The two followed so closely that nothing else changes what is seen by as much as a carry does.
  [[nodiscard]] bool followed_at_once() const { return gap_s_ < options_.at_once_s; }

 private:
  SurroundingsOptions options_;
  RecentView view_;
  double kept_ = 1.0;
  std::optional<Stamp> newest_;
  double gap_s_ = 1e9;
};

}  // namespace madori::localization
