#pragma once

#include <array>
#include <vector>

#include "core/frames.hpp"
#include "simulation/frames.hpp"

namespace madori::bench {

/// How far walls are from a place, metres, in eight directions (every 45 degrees of the Map frame from its x
/// axis on). Negative where nothing is met, or where the beam ends on the edge of something.
using Clearances = std::array<double, 8>;

/// `turn_rad` is added to every direction.
template <class Frame>
[[nodiscard]] Clearances clearances(const std::vector<Segment2<Frame>>& walls, const Point2<Frame>& at,
                                    double turn_rad = 0.0);

/// How the walls around a station stand to the vehicle there, against how they are drawn.
struct StationFit {
  int compared = 0;      ///< directions in which a wall is drawn near by and stands in truth
  int held = 0;          ///< ... at its drawn distance, or at the drawn share of the room's width
  double worst_m = 0.0;  ///< of the compared ones
  [[nodiscard]] bool good() const { return held == compared; }
};

/// Walls drawn within 4 m count; one that stands more than 2 m farther away than drawn is not there.
[[nodiscard]] StationFit compare(const Clearances& drawn, const Clearances& in_truth);

/// Whether any place within 1 m of `near` would hold every drawn clearance that it can be compared by: where
/// none does, building and drawing differ too much for anybody.
[[nodiscard]] bool can_hold(const Clearances& drawn, const std::vector<Segment2<simulation::Building>>& walls,
                            const Point2<simulation::Building>& near, double turn_rad);

}  // namespace madori::bench
