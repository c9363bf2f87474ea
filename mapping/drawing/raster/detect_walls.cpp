#include "mapping/drawing/raster/detect_walls.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/result.hpp"
#include "mapping/drawing/raster/arcs.hpp"
#include "mapping/drawing/raster/binarize.hpp"
#include "mapping/drawing/raster/columns.hpp"
#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/dash_ends.hpp"
#include "mapping/drawing/raster/dashed_marks.hpp"
#include "mapping/drawing/raster/dimension_lines.hpp"
#include "mapping/drawing/raster/hatch_lines.hpp"
#include "mapping/drawing/raster/hough_seeds.hpp"
#include "mapping/drawing/raster/line_picture.hpp"
#include "mapping/drawing/raster/mark_sizes.hpp"
#include "mapping/drawing/raster/merge_lines.hpp"
#include "mapping/drawing/raster/outer_faces.hpp"
#include "mapping/drawing/raster/pores.hpp"
#include "mapping/drawing/raster/refine_lines.hpp"
#include "mapping/drawing/raster/sheet_frame.hpp"
#include "mapping/drawing/raster/sort_lines.hpp"
#include "mapping/drawing/raster/strips.hpp"
#include "mapping/drawing/raster/stroke_width.hpp"
#include "mapping/drawing/raster/strokes.hpp"
#include "mapping/drawing/raster/text_marks.hpp"
#include "mapping/drawing/raster/trace_chains.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {
namespace {

/// Times the stages and passes their pictures and progress on.
class Stages {
 public:
  Stages(DetectedWalls& found, const StageSink& sink, const Progress& progress)
      : found_(found), sink_(sink), progress_(progress) {}
  void begin(const std::string& name, double share) {
    if (progress_) progress_(name, share);
    name_ = name;
    start_ = std::chrono::steady_clock::now();
  }
  void end(std::size_t count) {
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start_;
    found_.stages.push_back({name_, spent.count(), count});
  }
  void picture(const GrayImage& ink) {
    if (!sink_) return;
    GrayImage shown = ink;
    for (auto& pixel : shown.pixels) pixel = pixel != 0 ? 0 : 255;
    sink_(name_, shown);
  }

 private:
  DetectedWalls& found_;
  const StageSink& sink_;
  const Progress& progress_;
  std::string name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

DetectedWalls detect_walls(const GrayImage& image, const DetectionOptions& options, const StageSink& sink,
                           const Progress& progress) {
  if (!options.is_valid()) throw Error("wall detection", options.why_invalid(), "correct the option");
  if (image.empty()) throw Error("wall detection", "the picture has no pixels", "import another drawing");
  DetectedWalls found;
  Stages stages(found, sink, progress);
  stages.begin("binarize", 0);
  Binarized binary = binarize(image, options.threshold);
  stages.end(static_cast<std::size_t>(binary.threshold));
  stages.picture(binary.ink);
  stages.begin("marks", 0.2);
  const Components marks(binary.ink);
  stages.end(marks.all().size());
  stages.begin("text", 0.2);
  const double pen_px = pen_width_px(run_lengths(binary.ink, marks));
  const auto dashed = find_dashed(marks, pen_px);
  std::vector<bool> drop(marks.all().size(), false);
  for (const auto& dashes : dashed)
    for (const std::size_t i : dashes) drop[i] = true;
  const auto texts = find_text(marks, drop, pen_px, std::max(image.width_px, image.height_px));
  for (std::size_t i = 0; i < drop.size(); ++i)
    if (marks.all()[i].size() < 3 * pen_px) drop[i] = true;
  for (const auto& text : texts) {
    const double du = 0.5 * text.length_px * std::cos(text.angle_rad),
                 dv = 0.5 * text.length_px * std::sin(text.angle_rad);
    found.rejected.push_back(
        {{text.middle_u - du, text.middle_v - dv, text.middle_u + du, text.middle_v + dv},
         RejectReason::Text});
    for (const std::size_t i : text.marks) drop[i] = true;
  }
  const DrawnLines dashes = dash_axes(marks, dashed);
  for (const DrawnLine& dash : dashes) found.rejected.push_back({dash.segment, RejectReason::Dashed});
  const auto columns = find_columns(marks, drop, pen_px);
  marks.paint(binary.ink, drop, 0);
  fill_pores(binary.ink, pen_px);
  stages.end(texts.size() + dashed.size());
  stages.begin("strokes", 0.2);
  const Components cleaned(binary.ink);
  const double solid_px =
      options.min_thickness_px.value_or(solid_from_px(run_lengths(binary.ink, cleaned), pen_px));
  if (std::getenv("DUMP")) std::printf("solid %.1f\n", solid_px);
  Strokes strokes = split_strokes(binary.ink, solid_px);
  stages.end(static_cast<std::size_t>(10 * pen_px));
  stages.begin("solid", 0.2);
  stages.picture(strokes.solid);
  stages.end(0);
  stages.begin("lines", 0.4);
  GrayImage lines = line_picture(strokes);
  stages.end(0);
  stages.picture(lines);
  stages.begin("hough", 0.5);
  const double shortest = options.min_wall_length_px.value_or(std::max(10.0, 6 * pen_px));
  const auto seeds = hough_seeds(lines, shortest);
  stages.end(seeds.size());
  stages.begin("refine", 0.6);
  auto drawn = refine_lines(lines, seeds, {.shortest_px = shortest});
  stages.end(drawn.size());
  stages.begin("chains", 0.7);
  const auto chains = trace_chains(lines, 1.0, 4);
  int chain_id = 0;
  for (const Chain& chain : chains) {
    double total = 0;
    for (std::size_t i = 1; i < chain.corners.size(); ++i)
      total += std::hypot(chain.corners[i].u - chain.corners[i - 1].u,
                          chain.corners[i].v - chain.corners[i - 1].v);
    if (total < shortest) continue;
    for (std::size_t i = 1; i < chain.corners.size(); ++i) {
      const auto &a = chain.corners[i - 1], &b = chain.corners[i];
      DrawnLine line;
      line.segment = {a.u, a.v, b.u, b.v};
      line.solid_face = chain.solid_face;
      line.chain = chain_id;
      drawn.push_back(line);
    }
    ++chain_id;
  }
  stages.end(chains.size());
  stages.begin("merge", 0.7);
  drawn = merge_lines(std::move(drawn),
                      {.largest_gap_px = options.close_gap_px.value_or(std::max(4.0, 2 * pen_px))});
  stages.end(drawn.size());
  stages.begin("strips", 0.7);
  measure_strokes(drawn, binary.ink);
  const auto strips = find_strips(drawn, binary.ink, 0.025 * std::max(image.width_px, image.height_px));
  stages.end(strips.size());
  stages.begin("sort", 0.9);
  const WallStyle style = measure_style(drawn, strips, pen_px);
  const auto evidence = weigh_lines(drawn, strips, style);
  if (!options.keep_dimensions) reject_dimensions(drawn, texts, evidence, style, pen_px);
  if (!options.keep_furniture) reject_hatch(drawn, evidence);
  if (!options.keep_dashed) reject_dash_ends(drawn, dashes);
  reject_frame(drawn, evidence, style);
  reject_arcs(drawn, evidence, style);
  if (!options.keep_furniture) {
    const auto small = on_small_marks(drawn, cleaned, style);
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (small[i] && !drawn[i].rejected) drawn[i].rejected = RejectReason::Furniture;
  }
  sort_lines(drawn, evidence, style, options);
  if (!options.keep_outer_faces) {
    const auto outside = faces_outside(drawn, binary.ink);
    const auto spare = spare_faces(drawn, strips, style);
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (outside[i] && spare[i] && !drawn[i].rejected) drawn[i].rejected = RejectReason::Other;
  }
  for (const Column& column : columns)
    if (column.side_px > std::max(1.4 * style.thickness_px, 6 * pen_px) &&
        column.side_px < 3.5 * style.thickness_px)
      found.walls.insert(found.walls.end(), column.faces.begin(), column.faces.end());
  for (const auto& line : drawn) {
    if (line.rejected) {
      found.rejected.push_back({line.segment, *line.rejected});
    } else {
      found.walls.push_back(line.segment);
    }
  }
  stages.end(found.walls.size());
  return found;
}

}  // namespace madori::mapping
