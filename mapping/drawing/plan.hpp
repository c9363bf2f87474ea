#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// How to open a drawing file.
struct PlanOptions {
  std::optional<double> dpi;        ///< of a PDF or SVG that is rendered; stated resolution of a raster
  int page = 1;                     ///< of a PDF
  std::vector<std::string> layers;  ///< of a DXF; empty: chosen by name and content
  std::string unit;                 ///< of a DXF: mm, cm, dm, m, in or ft; empty: chosen by its evidence
};

/// Exact lines of a vector drawing, on the pixel grid of its picture.
struct PlanVectors {
  std::vector<PixelSegment> walls;
  std::vector<RejectedSegment> rejected;
};

/// What a drawing file holds.
struct Plan {
  GrayImage picture;
  std::optional<PlanVectors> vectors;  ///< a DXF: no need to look for lines in pixels
  std::optional<double> m_per_px;      ///< where the file knows its units
  std::string scale_method;            ///< "dxf-units" where m_per_px is set
  std::vector<std::string> notes;      ///< choices that were made, in words
  std::vector<std::string> left_out;   ///< what may be walls and was not read or not taken, in words
};

/// Opens a raster (PNG, JPEG, TIFF, BMP), PDF, SVG or DXF drawing. Throws Error naming file and mend.
[[nodiscard]] Plan load_plan(const std::filesystem::path& file, const PlanOptions& options);

}  // namespace madori::mapping
