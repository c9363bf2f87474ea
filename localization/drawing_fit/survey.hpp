#pragma once

#include "localization/drawing_fit/drawing_fit.hpp"

namespace madori::localization {

/// How the whole drawing compares with the place where the memory lies. Nats as in Alignment, all with the
/// same plain model of the drawing.
struct Survey {
  double here_nats = 0.0;
  double elsewhere_nats = 0.0;     ///< of the best other place
  Transform2<Map, Map> elsewhere;  ///< moves the memory there
  double mirrored_nats = 0.0;      ///< of the best place of the memory's mirror image
};

/// Looks at all places and turns of the drawing: is there a rival, or does the mirror image fit? Takes tenths
/// of a second on a large site; asked seldom.
[[nodiscard]] Survey survey(const DrawingFit& fit, const MemoryCloud& cloud);

/// The best place of all for a memory whose place is not known: what to move it by.
[[nodiscard]] Transform2<Map, Map> best_place_of_all(const DrawingFit& fit, const MemoryCloud& cloud);

}  // namespace madori::localization
