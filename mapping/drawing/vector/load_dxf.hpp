#pragma once

#include "mapping/drawing/plan.hpp"

namespace madori::mapping {

/// A DXF as exact walls on a pixel grid whose longer side has 4000 pixels. Walls are the layers named in the
/// options, else those whose names mean walls and columns, else every line that is nothing else (text,
/// dimensions, hatch, dashed lines, door arcs, furniture by layer name). The header's extents are not
/// trusted. Throws Error: unreadable, unknown layer, nothing drawn.
[[nodiscard]] Plan load_dxf(const std::filesystem::path& file, const PlanOptions& options);

}  // namespace madori::mapping
