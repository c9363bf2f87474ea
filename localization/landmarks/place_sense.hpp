#pragma once

#include <deque>

#include "localization/landmarks/surroundings.hpp"

namespace madori::localization::landmarks {

/// Whether the vehicle is at a place worth a landmark: a turning point (the heading turns by more than the
/// limit within half a corridor's width) or a crossing (more ways lead on than before, and more than a
/// corridor's two). Peter and Kiss (2020), section II.C.
class PlaceSense {
 public:
  explicit PlaceSense(double turning_point_rad = kTurningPoint_rad) : turning_point_rad_(turning_point_rad) {}

  /// The vehicle drove and turned by so much.
  void move(double way_m, double turn_rad);
  /// What it sees there; once a look, in the order of the way.
  [[nodiscard]] bool at_a_place(const Surroundings& seen);
  [[nodiscard]] double driven_m() const { return driven_m_; }

  static constexpr double kTurningPoint_rad = 1.0471975511965976;  ///< 60 degrees

 private:
  struct Heading {
    double path_m, yaw_rad;
  };
  double turning_point_rad_;
  double driven_m_ = 0.0;
  double yaw_rad_ = 0.0;
  std::deque<Heading> headings_;  ///< of the last half corridor width
  int openings_ = -1;             ///< of the last two scans that agreed
  int openings_before_ = -1;      ///< of the scan before
};

}  // namespace madori::localization::landmarks
