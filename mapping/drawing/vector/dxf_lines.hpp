#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/drawing/vector/dxf_units.hpp"

namespace madori::mapping {

/// A straight piece of a DXF entity (arcs and bulges in short chords), drawing units, y up.
struct DxfLine {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  std::size_t layer = 0;                ///< index into DxfContent::layers
  std::optional<RejectReason> no_wall;  ///< hatch, dashed, leader, quarter arc; Other: switched off
  bool door_leaf = false;  ///< from the middle of such an arc to one of its ends, or of a door drawn ajar

  [[nodiscard]] double length() const;
};

struct DxfPoint {
  double x = 0, y = 0;
};

/// A quarter arc, or a shorter one that may be the swing of a door drawn ajar, drawing units.
struct DoorSwing {
  DxfPoint hinge, from, to;
  double radius = 0;
  std::size_t first_line = 0, end_line = 0;  ///< its pieces among DxfContent::lines, the end not counted
};

struct DxfContent {
  std::vector<std::string> layers;
  std::vector<DxfLine> lines;
  std::vector<DoorSwing> swings;      ///< quarter arcs
  std::vector<DoorSwing> short_arcs;  ///< doors drawn ajar where a leaf hangs in them
  DxfUnitEvidence units;
  std::vector<std::string> unread;  ///< what GDAL does not read, in words
};

/// All lines of a DXF's model space (of its layouts where that is empty), block inserts resolved, by
/// GDAL/OGR. Coordinates that are not finite are left out. Throws Error when it is no readable DXF.
[[nodiscard]] DxfContent read_dxf_lines(const std::filesystem::path& file);

}  // namespace madori::mapping
