#pragma once

#include <stdint.h>

namespace madori::localization::landmarks {

/// What a landmark looked like when it was first met: up to 400 pairs of angle and range about the landmark's
/// origin, in its axes. Never changed afterwards. Angles to 0.0055 degrees, ranges to a millimetre.
class Descriptor {
 public:
  static constexpr int kMost = 400;

  /// Metres from the origin; left out at the origin itself, beyond 65 m, and once the descriptor is full.
  void add(double x_m, double y_m);
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] double range_m(int i) const { return 1e-3 * range_mm_[i]; }
  [[nodiscard]] double angle_rad(int i) const;
  /// Metres: half of the returns are nearer. Sets the size of the cells that it is matched with.
  [[nodiscard]] double median_range_m() const;

 private:
  uint16_t size_ = 0;
  uint16_t angle_[kMost] = {};  ///< 65536 make a turn
  uint16_t range_mm_[kMost] = {};
};

}  // namespace madori::localization::landmarks
