#pragma once

#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/memory/memory.hpp"

namespace madori::localization {

/// What a memory that lay right saw beside the walls that are known, as short walls: furniture, racks, walls
/// that nobody drew. A vehicle that was carried off finds its place by these where the drawing alone cannot
/// tell it. What was seen after the chain of motions had broken is left out: it lies anywhere.
[[nodiscard]] mapping::Walls seen_beside(const DrawingFit& walls, const Memory& memory);

}  // namespace madori::localization
