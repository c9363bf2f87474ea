#pragma once

#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/landmarks/crossings.hpp"
#include "localization/memory/memory.hpp"

namespace madori::localization {

/// A building as far as it is known when the vehicle is sought in it: by its walls, and by what an earlier
/// memory that lay right saw of it. A vehicle that was carried off, or switched on somewhere, finds its place
/// by these where the drawing cannot tell it.
struct KnownBuilding {
  DrawingFit walls;                ///< as they stand, and what was seen beside them, as short walls
  landmarks::Crossings crossings;  ///< that were driven through

  KnownBuilding(const DrawingFit& standing, const Memory& memory);
};

}  // namespace madori::localization
