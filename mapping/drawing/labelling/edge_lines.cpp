#include "mapping/drawing/labelling/edge_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/drawing/raster/merge_lines.hpp"

namespace madori::mapping {
namespace {

constexpr double kFewestPens = 1.5, kMostPens = 4;  // between them strokes end and bodies begin
constexpr double kWidestStroke = 0.008;             // of the drawing
constexpr std::size_t kPlaces = 25;
constexpr double kWidthBlur = 0.1;          // of a width, natural logarithm
constexpr double kGapInPens = 2, kGap = 4;  // a stroke that crosses, and what its corners hide

/// The width, of those that can divide strokes from bodies, that the drawing uses least.
double widest_stroke_px(const LabelSheet& sheet) {
  const double widest = kWidestStroke * sheet.edges.size_px(),
               pen = std::min(sheet.strokes.pen_px, 0.5 * widest);
  const double from = std::log(kFewestPens * pen), to = std::log(std::min(kMostPens * pen, widest));
  const double step = (to - from) / (kPlaces - 1);
  std::array<double, kPlaces> crowd{};
  for (std::size_t i = 0; i < sheet.strokes.width_px.size(); ++i)
    for (std::size_t k = 0; k < kPlaces && sheet.strokes.width_px[i] > 0; ++k) {
      const double off =
          (from + static_cast<double>(k) * step - std::log(sheet.strokes.width_px[i])) / kWidthBlur;
      crowd[k] += sheet.edges.edges[i].length_px * std::exp(-0.5 * off * off);
    }
  const auto least = std::min_element(crowd.begin(), crowd.end()) - crowd.begin();
  return std::exp(from + static_cast<double>(least) * step);
}

}  // namespace

EdgeStrokes::EdgeStrokes(const LabelSheet& sheet) : sheet_(sheet), widest_px_(widest_stroke_px(sheet)) {}

std::vector<float> EdgeStrokes::together(const std::vector<float>& probabilities) const {
  std::vector<float> both = probabilities;
  for (std::size_t i = 0; i < both.size(); ++i)
    if (is_stroke(i))
      both[i] = 0.5F * (both[i] + probabilities[static_cast<std::size_t>(sheet_.groups.partner[0][i])]);
  return both;
}

DrawnLines EdgeStrokes::lines(const std::vector<float>& probabilities, double wall_from,
                              std::optional<double> gap_px) const {
  DrawnLines lines;
  for (std::size_t i = 0; i < sheet_.edges.edges.size(); ++i) {
    const Edge& edge = sheet_.edges.edges[i];
    DrawnLine line{.segment = edge.segment, .solid_face = !is_stroke(i), .probability = probabilities[i]};
    if (!line.solid_face) {
      line.stroke_px = sheet_.strokes.width_px[i];
      const double u = 0.5 * line.stroke_px * edge.normal.x, v = 0.5 * line.stroke_px * edge.normal.y;
      line.segment = {line.segment.u1 + u, line.segment.v1 + v, line.segment.u2 + u, line.segment.v2 + v};
    }
    if (line.probability < wall_from) line.rejected = RejectReason::Other;
    lines.push_back(line);
  }
  return merge_lines(std::move(lines), gap_px.value_or(std::max(kGap, kGapInPens * sheet_.strokes.pen_px)));
}

}  // namespace madori::mapping
