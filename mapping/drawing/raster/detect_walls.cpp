#include "mapping/drawing/raster/detect_walls.hpp"

#include "core/result.hpp"
#include "mapping/drawing/raster/choose_walls.hpp"
#include "mapping/drawing/raster/clean_marks.hpp"
#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/extract_lines.hpp"
#include "mapping/drawing/raster/settle_lines.hpp"
#include "mapping/drawing/raster/skew.hpp"
#include "mapping/drawing/raster/stage_clock.hpp"
#include "mapping/drawing/raster/working_ink.hpp"

namespace madori::mapping {

DetectedWalls detect_walls(const GrayImage& image, const DetectionOptions& chosen, const StageSink& sink,
                           const Progress& progress) {
  if (!chosen.is_valid()) throw Error("wall detection", chosen.why_invalid(), "correct the option");
  if (image.empty()) throw Error("wall detection", "the picture has no pixels", "import another drawing");
  DetectedWalls found;
  StageClock clock(found, sink, progress);

  clock.begin("binarize", 0);  // ink or paper, at a resolution that suits the pen
  WorkingInk working = working_ink(image, chosen.threshold);
  GrayImage& ink = working.ink;
  const DetectionOptions options = resized(chosen, working.factor);
  clock.picture("binarize", ink);
  clock.end(static_cast<std::size_t>(working.threshold));

  clock.begin("marks", 0.15);  // text, dashed lines, dirt: known by their marks alone
  CleanedMarks cleaned = clean_marks(ink, working.marks, working.pen_px, options);
  const Components marks(ink);
  clock.picture("marks", ink);
  clock.end(marks.all().size());

  DrawnLines drawn = extract_lines(ink, marks, cleaned.pen_px, options, clock);

  clock.begin("sort", 0.9);  // walls, and what else lines stand for
  const WallStyle style = choose_walls(drawn, ink, marks, cleaned, options);
  clock.end(drawn.size());

  clock.begin("settle", 0.95);  // to a fraction of a pixel
  settle_lines(drawn, {image, static_cast<double>(image.width_px) / ink.width_px,
                       static_cast<double>(image.height_px) / ink.height_px, working.bright_lines});
  found.walls = column_faces(cleaned, style);
  found.rejected = std::move(cleaned.rejected);
  for (const DrawnLine& line : drawn) {
    if (line.rejected) {
      found.rejected.push_back({line.segment, *line.rejected});
    } else {
      found.walls.push_back(line.segment);
    }
  }
  rescale(found, ink, image);
  found.skew_deg = measure_skew_deg(found.walls);
  if (options.straighten) straighten(found.walls, found.skew_deg);
  clock.end(found.walls.size());
  if (progress) progress("done", 1);
  return found;
}

}  // namespace madori::mapping
