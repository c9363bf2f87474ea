#include "mapping/drawing/read_drawing.hpp"

#include <utility>

#include "core/result.hpp"
#include "mapping/drawing/labelling/edge_lines.hpp"
#include "mapping/drawing/labelling/taught_edges.hpp"
#include "mapping/drawing/labelling/wall_threshold.hpp"
#include "mapping/drawing/raster/settle_lines.hpp"
#include "mapping/drawing/raster/skew.hpp"
#include "mapping/drawing/raster/stage_clock.hpp"

namespace madori::mapping {

namespace {

/// The edges of a sheet in black on white, as dark as `darkness` (one an edge, 0..1) says.
GrayImage picture_of(const EdgeSheet& sheet, const std::vector<float>& darkness) {
  GrayImage picture{sheet.grey.width_px, sheet.grey.height_px, {}, sheet.grey.dpi};
  for (std::size_t pixel = 0; pixel < sheet.map.size(); ++pixel) {
    const int edge = sheet.map.edge_at(pixel);
    picture.pixels.push_back(
        edge < 0 ? 255 : static_cast<std::uint8_t>(225 * (1 - darkness[static_cast<std::size_t>(edge)])));
  }
  return picture;
}

/// Lines in pixels of the sheet become walls and others in pixels of the drawing.
void hand_over(const DrawnLines& lines, const GreyDrawing& drawing, const DetectionOptions& options,
               DetectedWalls& found) {
  for (const DrawnLine& line : lines) {
    const PixelSegment& s = line.segment;
    const PixelSegment own{s.u1 * drawing.scale.x, s.v1 * drawing.scale.y, s.u2 * drawing.scale.x,
                           s.v2 * drawing.scale.y};
    if (line.rejected || own.length_px() < options.min_wall_length_px.value_or(0)) {
      found.rejected.push_back({own, line.rejected.value_or(RejectReason::TooShort), line.probability});
    } else {
      found.walls.push_back(own);
      found.probabilities.push_back(line.probability);
    }
  }
}

}  // namespace

DetectedWalls read_drawing(const GrayImage& image, const DetectionOptions& options, const StageSink& sink,
                           const Progress& progress) {
  if (!options.is_valid()) throw Error("wall detection", options.why_invalid(), "correct the option");
  if (image.empty()) throw Error("wall detection", "the picture has no pixels", "import another drawing");
  DetectedWalls found;
  StageClock clock(found.stages, progress);

  clock.begin("edges", 0.1);  // every straight edge between a darker and a brighter side
  EdgeSheet edges = find_edges(image);
  const std::size_t count = edges.edges.size();
  if (sink) sink("greys", edges.grey);
  if (sink) sink("edges", picture_of(edges, std::vector<float>(count, 1)));
  clock.end(count);

  clock.begin("features", 0.5);  // what surrounds each edge, relative to the whole sheet
  const LabelSheet sheet = label_sheet(std::move(edges));
  clock.end(sheet.features.names().size());

  clock.begin("judge", 0.7);  // how probable it is that each edge is a wall
  const WallModel model = options.model.empty() ? WallModel::shipped() : WallModel::load(options.model);
  const EdgeStrokes strokes(sheet);
  const auto probabilities =
      strokes.together(taught_edges(sheet, judge_edges(sheet, model), options.touches));
  if (sink) sink("judged", picture_of(sheet.edges, probabilities));
  clock.end(count);

  clock.begin("lines", 0.9);  // edges become lines, walls from the sheet's own threshold on
  const double wall_from =
      wall_threshold(probabilities, sheet.edges.edges, options.strictness.value_or(kStrictness));
  const GreyDrawing drawing{image,
                            {static_cast<double>(image.width_px) / sheet.edges.grey.width_px,
                             static_cast<double>(image.height_px) / sheet.edges.grey.height_px},
                            sheet.edges.dark_ground};
  std::optional<double> gap_px;
  if (options.close_gap_px) gap_px = *options.close_gap_px / drawing.scale.x;
  DrawnLines lines = strokes.lines(probabilities, wall_from, gap_px);
  for (DrawnLine& line : lines) line.probability = model.told(line.probability);
  clock.end(lines.size());

  clock.begin("settle", 0.95);  // to a fraction of a pixel, where the greys of the drawing have them
  settle_lines(lines, drawing);
  hand_over(lines, drawing, options, found);
  found.skew_deg = measure_skew_deg(found.walls);
  if (options.straighten) straighten(found.walls, found.skew_deg);
  clock.end(found.walls.size());
  if (progress) progress("done", 1);
  return found;
}

}  // namespace madori::mapping
