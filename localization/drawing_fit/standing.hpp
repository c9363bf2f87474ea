#pragma once

#include "localization/drawing_fit/memory_cloud.hpp"

namespace madori::localization {

/// Weighs for every surface of the memory's cloud what was seen of it against what was seen through it, and
/// sets `standing`. A wall stops every ray; a person, a cart, or what one laser met of a ceiling is looked
/// through from elsewhere or at another time. What the keyframes around one stop say is not independent (they
/// share the moment and the sight), so a stop has one vote, shared between them. Slanted looks say nothing:
/// their rays graze.
void weigh_standing(const Memory& memory, MemoryCloud& cloud);

/// memory_cloud() of all keyframes with `standing` known: what walls are made of.
[[nodiscard]] MemoryCloud standing_cloud(const Memory& memory);

}  // namespace madori::localization
