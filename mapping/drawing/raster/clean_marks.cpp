#include "mapping/drawing/raster/clean_marks.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/drawing/raster/dash_ends.hpp"
#include "mapping/drawing/raster/dashed_marks.hpp"
#include "mapping/drawing/raster/pores.hpp"

namespace madori::mapping {
namespace {

constexpr double kDirtInPens = 3;

PixelSegment base_line(const TextGroup& text) {
  const double du = 0.5 * text.length_px * std::cos(text.angle_rad);
  const double dv = 0.5 * text.length_px * std::sin(text.angle_rad);
  return {text.middle_u - du, text.middle_v - dv, text.middle_u + du, text.middle_v + dv};
}

}  // namespace

CleanedMarks clean_marks(GrayImage& ink, const Components& marks, double pen_px,
                         const DetectionOptions& options) {
  CleanedMarks cleaned;
  cleaned.pen_px = pen_px;
  std::vector<bool> drop(marks.all().size(), false);
  if (!options.keep_dashed) {
    const auto dashed = find_dashed(marks, cleaned.pen_px);
    cleaned.dashes = dash_axes(marks, dashed);
    for (const auto& dashes : dashed)
      for (const std::size_t i : dashes) drop[i] = true;
  }
  for (const DrawnLine& dash : cleaned.dashes)
    cleaned.rejected.push_back({dash.segment, RejectReason::Dashed});
  cleaned.texts = find_text(marks, drop, cleaned.pen_px, std::max(ink.width_px, ink.height_px));
  for (const TextGroup& text : cleaned.texts) {
    cleaned.rejected.push_back({base_line(text), RejectReason::Text});
    for (const std::size_t i : text.marks) drop[i] = true;
  }
  for (std::size_t i = 0; i < drop.size(); ++i)
    drop[i] = drop[i] || marks.all()[i].size() < kDirtInPens * cleaned.pen_px;
  cleaned.columns = find_columns(marks, drop, cleaned.pen_px);
  marks.paint(ink, drop, 0);
  fill_pores(ink, cleaned.pen_px);
  return cleaned;
}

}  // namespace madori::mapping
