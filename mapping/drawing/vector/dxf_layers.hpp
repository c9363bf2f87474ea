#pragma once

#include <string>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// What a layer's name says about its lines. Names of several languages and of the usual CAD layer standards.
enum class LayerKind { Wall, Column, NoWall, Unknown };

struct LayerMeaning {
  LayerKind kind = LayerKind::Unknown;
  RejectReason reason = RejectReason::Other;  ///< of a NoWall
  bool says_wall = false;                     ///< a NoWall whose name says wall, too
};

/// "xref$0$A-WALL", "Wand (neu)" and "02_壁" are walls; "A-DIMS", "Bemaßung" and "Shelves" are none; nor is
/// "WALL-TEXT", but "Wand-Textilhalle" and "INDOOR-WALL" are.
[[nodiscard]] LayerMeaning layer_meaning(const std::string& name);

}  // namespace madori::mapping
