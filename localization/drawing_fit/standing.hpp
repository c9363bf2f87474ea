#pragma once

#include "localization/drawing_fit/memory_cloud.hpp"

namespace madori::localization {

/// memory_cloud() of all keyframes, what walls are made of: for every surface what was seen of it is weighed
/// against what was seen through it, and `standing` is set. A wall stops every ray; a person, a cart, or what
/// one laser met of a ceiling is looked through from elsewhere or at another time. What the keyframes around
/// one stop say is not independent (they share the moment and the sight), so a stop has one vote, shared
/// between them. Slanted looks say nothing: their rays graze.
[[nodiscard]] MemoryCloud standing_cloud(const Memory& memory);

}  // namespace madori::localization
