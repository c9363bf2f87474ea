#pragma once

#include <optional>
#include <string>
#include <vector>

namespace madori::mapping {

/// What a DXF tells about the length of its unit.
struct DxfUnitEvidence {
  std::optional<int> insunits;     ///< header $INSUNITS (AutoCAD DXF reference), 0 = unitless
  std::optional<int> measurement;  ///< header $MEASUREMENT: 0 imperial, 1 metric
  double extent = 0;               ///< longer side of the drawn lines, drawing units
  std::vector<double> door_radii;  ///< of quarter arcs, drawing units
  bool imperial_texts = false;     ///< figures such as 12'-6" stand in it
};

struct DxfUnit {
  double metres = 0;
  std::string note;  ///< which unit, and why
};

/// The unit that explains the drawing: $INSUNITS where a building comes out of it, else $MEASUREMENT and
/// plausibility (a building is 3 m to 2 km long, a door about 0.9 m wide). Nothing where none is plausible,
/// or several alike.
[[nodiscard]] std::optional<DxfUnit> choose_unit(const DxfUnitEvidence& evidence);

/// The unit that the user named: mm, cm, dm, m, in, ft, yd; nothing for another word.
[[nodiscard]] std::optional<DxfUnit> named_unit(const std::string& word);

}  // namespace madori::mapping
