#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapping/drawing/vector/dxf_units.hpp"

namespace madori::mapping {

/// A straight piece of a DXF entity (arcs and bulges in short chords), drawing units, y up.
struct DxfLine {
  double x1{}, y1{}, x2{}, y2{};
  std::size_t layer{};  ///< index into DxfContent::layers
  bool dashed = false;
  bool hatch = false;
  bool door_arc = false;   ///< of a quarter circle
  bool door_leaf = false;  ///< from the middle of such an arc to one of its ends, or of a door drawn ajar

  [[nodiscard]] double length() const;
};

struct DxfPoint {
  double x{}, y{};
};

/// A quarter arc, or a shorter one that may be the swing of a door drawn ajar, drawing units.
struct DoorSwing {
  DxfPoint hinge, from, to;
  double radius{};
  std::size_t first_line{}, end_line{};  ///< its pieces among DxfContent::lines, the end not counted
};

struct DxfContent {
  std::vector<std::string> layers;
  std::vector<DxfLine> lines;
  std::vector<DoorSwing> swings;      ///< quarter arcs
  std::vector<DoorSwing> short_arcs;  ///< doors drawn ajar where a leaf hangs in them
  DxfUnitEvidence units;
};

/// All lines of a DXF, block inserts resolved, by GDAL/OGR. Coordinates that are not finite are left out.
/// Throws Error when it is no readable DXF.
[[nodiscard]] DxfContent read_dxf_lines(const std::filesystem::path& file);

}  // namespace madori::mapping
