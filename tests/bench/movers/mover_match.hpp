#pragma once

#include <vector>

#include "tests/bench/movers/true_mover.hpp"

namespace madori::bench {

inline constexpr double kGateM = 0.5;  ///< from an outline: a person's breadth, half a forklift's

/// What there is to say of one that is told to move.
enum class Verdict {
  Right,    ///< something that moves is within the gate
  Neither,  ///< a body that has stood for a second, or a door's leaf, is
  Wrong
};

struct Match {
  static constexpr int kNone = -1;
  std::vector<int> told_of;  ///< by true mover: which of those told is it; kNone where nobody tells of it
  std::vector<Verdict> verdicts;  ///< by told mover
};

/// The nearest pairs first, each of a pair once: by the distance of the told place from the outline, then
/// from its centre. A second one that is told of the same body is right as well.
[[nodiscard]] Match match_movers(const std::vector<ToldMover>& told, const std::vector<TrueMover>& truths);

/// Metres from a place to the outline of a body; zero inside.
[[nodiscard]] double distance_to(const simulation::Body& body, const Point2<Building>& at);

}  // namespace madori::bench
