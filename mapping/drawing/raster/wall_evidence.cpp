#include "mapping/drawing/raster/wall_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {
namespace {

constexpr double kLongForWidth = 3;   // a strip is at least this much longer than wide
constexpr double kFilledFrom = 0.75;  // ink share
constexpr double kSidePeak =
    0.15;  // a second wall thickness has at least this share of the first one's length
constexpr double kFilledOnly = 0.9;  // a drawing that fills its walls draws furniture with empty lines
constexpr double kWidest = 2.5;      // common wall thicknesses
constexpr double kPensDiffer = 0.12;
constexpr double kFinerPen = 0.72;  // pens of a drawing differ by the factor 2 (ISO 128-20); the rest is for
constexpr double kGrid = 0.5;       // what the pixel grid adds, pixels
constexpr double kNarrowest = 2.5;
constexpr double kOwnWall = 0.5;      // of a line's length
using Lengths = std::vector<double>;  // of strips, by rounded width

Lengths widths_of(const DrawnLines& lines, const std::vector<Strip>& strips, bool filled) {
  Lengths lengths(8, 0);
  for (const Strip& strip : strips) {
    if (strip.length_px() < kLongForWidth * strip.width_px || strip.width_px < kNarrowest) continue;
    if (lines[strip.line].length_px() < 4 * strip.width_px || (strip.ink_share >= kFilledFrom) != filled)
      continue;
    const auto bin = static_cast<std::size_t>(std::lround(strip.width_px));
    if (bin >= lengths.size()) lengths.resize(bin + 1, 0);
    lengths[bin] += strip.length_px();
  }
  return lengths;
}

/// Sums over neighbouring widths; the reach grows with the width.
Lengths smoothed(const Lengths& lengths) {
  Lengths smooth(lengths.size(), 0);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const std::size_t reach = 1 + i / 10;
    for (std::size_t j = i - std::min(i, reach); j <= std::min(i + reach, lengths.size() - 1); ++j)
      smooth[i] += lengths[j];
  }
  return smooth;
}

/// The mean width around the peak.
double peak_width(const Lengths& lengths, const Lengths& smooth) {
  const auto peak = static_cast<std::size_t>(std::max_element(smooth.begin(), smooth.end()) - smooth.begin());
  const std::size_t reach = 1 + peak / 10;
  double sum = 0, all = 0;
  for (std::size_t j = peak - std::min(peak, reach); j <= std::min(peak + reach, lengths.size() - 1); ++j) {
    sum += lengths[j] * static_cast<double>(j);
    all += lengths[j];
  }
  return sum / all;
}

double total(const Lengths& lengths, double up_to) {
  double sum = 0;
  for (std::size_t i = 0; i < lengths.size() && static_cast<double>(i) <= up_to; ++i) sum += lengths[i];
  return sum;
}

double last_above(const Lengths& lengths, double least) {
  double last = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i] >= least) last = static_cast<double>(i);
  return last;
}

/// The stroke of most of the length of long strips at wall thickness.
double wall_pen(const DrawnLines& lines, const std::vector<Strip>& strips, const WallStyle& style,
                double pen_px) {
  std::vector<std::pair<double, double>> strokes;  // width, length
  double all = 0;
  for (const Strip& strip : strips) {
    const DrawnLine& line = lines[strip.line];
    if (line.solid_face || strip.length_px() < 12 * strip.width_px ||
        strip.width_px > 1.6 * style.thickness_px)
      continue;
    strokes.emplace_back(line.stroke_px, strip.length_px());
    all += strip.length_px();
  }
  std::sort(strokes.begin(), strokes.end());
  double seen = 0;
  for (const auto& [stroke, length] : strokes)
    if ((seen += length) >= 0.5 * all) return stroke;
  return pen_px;
}

/// How much of the length of longer pen lines is finer than the pen of the walls.
double fine_share(const DrawnLines& lines, const WallStyle& style, double pen_px) {
  double all = 0, fine = 0;
  for (const DrawnLine& line : lines) {
    if (line.solid_face || line.length_px() < 10 * pen_px) continue;
    all += line.length_px();
    if (line.stroke_px <= style.finer_than_px) fine += line.length_px();
  }
  return all > 0 ? fine / all : 0;
}

/// Lines that are mostly faces of a filled wall: what runs along them with nothing between is a cupboard.
std::vector<bool> faces_of_filled(const DrawnLines& lines, const std::vector<Strip>& strips,
                                  const WallStyle& style) {
  std::vector<double> filled_px(lines.size(), 0);
  for (const Strip& strip : strips)
    if (strip.ink_share >= kFilledFrom && strip.width_px <= style.widest_filled_px &&
        strip.width_px >= style.narrowest_px && strip.length_px() >= 2 * strip.width_px)
      filled_px[strip.line] += strip.length_px();
  std::vector<bool> faces(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) faces[i] = filled_px[i] >= kOwnWall * lines[i].length_px();
  return faces;
}

}  // namespace

WallStyle measure_style(const DrawnLines& lines, const std::vector<Strip>& strips, double pen_px) {
  const Lengths raw_empty = widths_of(lines, strips, false), raw_filled = widths_of(lines, strips, true);
  Lengths raw(std::max(raw_empty.size(), raw_filled.size()), 0);
  for (std::size_t i = 0; i < raw_empty.size(); ++i) raw[i] += raw_empty[i];
  for (std::size_t i = 0; i < raw_filled.size(); ++i) raw[i] += 2 * raw_filled[i];
  const Lengths empty = smoothed(raw_empty), filled = smoothed(raw_filled), both = smoothed(raw);
  WallStyle style;
  const double most = *std::max_element(both.begin(), both.end());
  style.thickness_px = most > 0 ? peak_width(raw, both) : 4 * pen_px;
  style.narrowest_px = std::max(kNarrowest, 0.25 * style.thickness_px);
  style.bold_px = std::max(4.0, 2.2 * pen_px);
  double bold = 0;
  for (const DrawnLine& line : lines)
    if (!line.solid_face && line.stroke_px >= style.bold_px && line.length_px() > 6 * line.stroke_px)
      bold += 2 * line.length_px();
  const double fill = total(raw_filled, 4 * style.thickness_px) + bold;
  style.filled_share = fill / std::max(1.0, fill + total(raw_empty, 2 * style.thickness_px));
  style.wall_pen_px = wall_pen(lines, strips, style, pen_px);
  style.finer_than_px = std::min(kFinerPen * style.wall_pen_px, style.wall_pen_px - kGrid);
  style.pens_differ = fine_share(lines, style, pen_px) > kPensDiffer;
  const double last_filled = std::min(last_above(filled, kSidePeak * most), kWidest * style.thickness_px),
               last_empty = std::min(last_above(empty, kSidePeak * most), kWidest * style.thickness_px);
  style.widest_filled_px = 1.3 * std::max(style.thickness_px, last_filled) + 1;
  if (style.filled_share > kFilledOnly) return style;
  style.widest_empty_px = style.filled_share > 0.5 ? 1.6 * style.thickness_px + 1
                                                   : 1.3 * std::max(style.thickness_px, last_empty) + 1;
  return style;
}

std::vector<Evidence> weigh_lines(const DrawnLines& lines, const std::vector<Strip>& strips,
                                  const WallStyle& style) {
  std::vector<Evidence> evidence(lines.size());
  const auto own_wall = faces_of_filled(lines, strips, style);
  for (const Strip& strip : strips) {
    const bool filled = strip.ink_share >= kFilledFrom;
    if (strip.width_px > (filled ? style.widest_filled_px : style.widest_empty_px)) continue;
    if (strip.width_px < style.narrowest_px || strip.length_px() < 2 * strip.width_px) continue;
    if (!filled && own_wall[strip.partner] && !own_wall[strip.line]) continue;
    Evidence& e = evidence[strip.line];
    e.width_px =
        (e.width_px * e.paired_px + strip.width_px * strip.length_px()) / (e.paired_px + strip.length_px());
    e.paired_px += strip.length_px();
    if (filled) e.filled_px += strip.length_px();
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].solid_face && lines[i].stroke_px >= style.bold_px)
      evidence[i] = {lines[i].length_px(), lines[i].length_px(), lines[i].stroke_px};
  return evidence;
}

}  // namespace madori::mapping
