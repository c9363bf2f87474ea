#include "mapping/drawing/raster/choose_walls.hpp"

#include <algorithm>

#include "mapping/drawing/raster/arcs.hpp"
#include "mapping/drawing/raster/dash_ends.hpp"
#include "mapping/drawing/raster/dimension_lines.hpp"
#include "mapping/drawing/raster/hatch_lines.hpp"
#include "mapping/drawing/raster/mark_sizes.hpp"
#include "mapping/drawing/raster/outer_faces.hpp"
#include "mapping/drawing/raster/sheet_frame.hpp"
#include "mapping/drawing/raster/sort_lines.hpp"
#include "mapping/drawing/raster/strips.hpp"

namespace madori::mapping {
namespace {

constexpr double kWidestShare = 0.025;  // of the drawing: further apart are no two faces of a wall
constexpr double kThickestWall = 1.2;   // metres
constexpr double kSolidWider = 2;       // times: what is filled from face to face is one wall, however thick
constexpr double kFilled = 0.9;

void reject_where(DrawnLines& drawn, const std::vector<bool>& which, RejectReason reason) {
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (which[i] && !drawn[i].rejected) drawn[i].rejected = reason;
}

/// Pairs further apart than two faces are count where the fill between them says that they belong together.
std::vector<Strip> wall_strips(const DrawnLines& drawn, const GrayImage& ink, double widest_px) {
  auto strips = find_strips(drawn, ink, kSolidWider * widest_px);
  std::erase_if(strips, [&](const Strip& strip) {
    const bool solid = drawn[strip.line].solid_face && drawn[strip.partner].solid_face;
    return strip.width_px > widest_px && !(solid && strip.ink_share > kFilled);
  });
  return strips;
}

void reject_outer_faces(DrawnLines& drawn, const std::vector<Strip>& strips, const WallStyle& style,
                        const GrayImage& ink) {
  auto spare = spare_faces(drawn, strips, style);
  for (std::size_t i = 0; i < drawn.size(); ++i) spare[i] = spare[i] && !drawn[i].rejected;
  const auto outside = faces_outside(drawn, spare, ink);
  reject_where(drawn, outside, RejectReason::Other);
  reject_where(drawn, cladding(drawn, outside, strips, style), RejectReason::Other);
}

}  // namespace

WallStyle choose_walls(DrawnLines& drawn, const GrayImage& ink, const Components& marks,
                       const CleanedMarks& cleaned, const DetectionOptions& options) {
  double widest = kWidestShare * std::max(ink.width_px, ink.height_px);
  if (options.m_per_px) widest = std::min(widest, kThickestWall / *options.m_per_px);
  const auto strips = wall_strips(drawn, ink, widest);
  const WallStyle style = measure_style(drawn, strips, cleaned.pen_px);
  const auto evidence = weigh_lines(drawn, strips, style);
  if (!options.keep_dimensions) reject_dimensions(drawn, cleaned.texts, evidence, style, cleaned.pen_px);
  if (!options.keep_furniture) reject_hatch(drawn, evidence);
  if (!options.keep_dashed) reject_dash_ends(drawn, cleaned.dashes);
  reject_frame(drawn, evidence, style);
  reject_arcs(drawn, evidence, style);
  if (!options.keep_furniture) {
    reject_where(drawn, on_small_marks(drawn, marks, style), RejectReason::Furniture);
    sort_lines(drawn, evidence, style);
  }
  if (!options.keep_outer_faces) reject_outer_faces(drawn, strips, style, ink);
  if (options.min_wall_length_px)
    for (DrawnLine& line : drawn)
      if (!line.rejected && line.length_px() < *options.min_wall_length_px)
        line.rejected = RejectReason::TooShort;
  return style;
}

std::vector<PixelSegment> column_faces(const CleanedMarks& cleaned, const WallStyle& style) {
  std::vector<PixelSegment> faces;
  for (const Column& column : cleaned.columns) {
    const bool large = column.side_px > std::max(1.4 * style.thickness_px, 6 * cleaned.pen_px);
    if (large && column.side_px < 3.5 * style.thickness_px)
      faces.insert(faces.end(), column.faces.begin(), column.faces.end());
  }
  return faces;
}

}  // namespace madori::mapping
