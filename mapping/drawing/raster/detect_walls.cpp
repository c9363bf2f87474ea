#include "mapping/drawing/raster/detect_walls.hpp"

#include <algorithm>
#include <utility>

#include "core/result.hpp"
#include "mapping/drawing/labelling/label_lines.hpp"
#include "mapping/drawing/labelling/line_cover.hpp"
#include "mapping/drawing/labelling/taught_edges.hpp"
#include "mapping/drawing/labelling/wall_threshold.hpp"
#include "mapping/drawing/raster/choose_walls.hpp"
#include "mapping/drawing/raster/clean_marks.hpp"
#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/extract_lines.hpp"
#include "mapping/drawing/raster/settle_lines.hpp"
#include "mapping/drawing/raster/skew.hpp"
#include "mapping/drawing/raster/stage_clock.hpp"
#include "mapping/drawing/raster/working_ink.hpp"

namespace madori::mapping {

namespace {

constexpr double kNoise = 0.3;  // of the pixels; white noise has 0.5, the densest hatching 0.15

/// Where ink and paper change at every other pixel nothing is drawn, and all of it would be lines.
void refuse_noise(const GrayImage& ink, double factor) {
  std::size_t changes = 0;
  for (int v = 0; v < ink.height_px; ++v)
    for (int u = 1; u < ink.width_px; ++u) changes += ink.at(u, v) != ink.at(u - 1, v) ? 1 : 0;
  if (factor * static_cast<double>(changes) > kNoise * static_cast<double>(ink.pixels.size()))
    throw Error("wall detection", "the picture is noise, no line can be told in it",
                "scan it again, or smooth it first");
}

/// A drawing as lines, each with the reason where a rule explains it as something else than a wall.
struct RuledLines {
  WorkingInk working;
  CleanedMarks cleaned;
  DrawnLines drawn;
  WallStyle style;
  double u_scale = 1, v_scale = 1;  // pixels of the drawing for one of the lines
};

RuledLines rule_lines(const GrayImage& image, const DetectionOptions& chosen, StageClock& clock) {
  clock.begin("binarize", 0);  // ink or paper, at a resolution that suits the pen
  RuledLines ruled{working_ink(image, chosen.threshold), {}, {}, {}};
  GrayImage& ink = ruled.working.ink;
  const DetectionOptions options = resized(chosen, ruled.working.factor);
  ruled.u_scale = static_cast<double>(image.width_px) / ink.width_px;
  ruled.v_scale = static_cast<double>(image.height_px) / ink.height_px;
  clock.picture("binarize", ink);
  clock.end(static_cast<std::size_t>(ruled.working.threshold));

  refuse_noise(ink, ruled.working.factor);

  clock.begin("marks", 0.15);  // text, dashed lines, dirt: known by their marks alone
  ruled.cleaned = clean_marks(ink, ruled.working.marks, ruled.working.pen_px, options);
  const Components marks(ink);
  clock.picture("marks", ink);
  clock.end(marks.all().size());

  ruled.drawn = extract_lines(ink, marks, ruled.cleaned.pen_px, options, clock);

  clock.begin("sort", 0.8);  // what else lines stand for
  ruled.style = choose_walls(ruled.drawn, ink, marks, ruled.cleaned, options);
  clock.end(ruled.drawn.size());
  return ruled;
}

constexpr double kAsGood = 0.75;  // of the F measure that the model expects of its own walls

/// What the model makes of a sheet.
struct JudgedSheet {
  LabelSheet sheet;
  std::vector<float> probabilities;
  double wall_from = 0.5;
};

JudgedSheet judge(const GrayImage& image, const DetectionOptions& chosen) {
  JudgedSheet judged;
  judged.sheet = label_sheet(image);
  const WallModel model = chosen.model.empty() ? WallModel::shipped() : WallModel::load(chosen.model);
  judged.probabilities = taught_edges(judged.sheet, judge_edges(judged.sheet, model), chosen.touches);
  judged.wall_from =
      wall_threshold(judged.probabilities, judged.sheet.edges.edges, chosen.strictness.value_or(1));
  return judged;
}

/// The F measure that the model expects, where an edge is taken by this share (0..1).
double expected_f(const JudgedSheet& judged, const std::vector<float>& taken) {
  double right = 0, all = 0, expected = 0;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const double length = judged.sheet.edges.edges[i].length_px;
    right += taken[i] * judged.probabilities[i] * length;
    all += taken[i] * length;
    expected += judged.probabilities[i] * length;
  }
  return all + expected > 0 ? 2 * right / (all + expected) : 0;
}

/// The walls of the rules stay where the model itself expects hardly more of its own.
bool rules_do(const JudgedSheet& judged, const RuledLines& ruled, const DetectionOptions& chosen) {
  if (!chosen.model.empty() || chosen.strictness || !chosen.touches.empty()) return false;
  std::vector<bool> walls;
  for (const DrawnLine& line : ruled.drawn) walls.push_back(!line.rejected);
  if (std::find(walls.begin(), walls.end(), true) == walls.end()) return false;
  const double factor = judged.sheet.edges.factor;
  const LineCover cover(ruled.drawn, judged.sheet.edges, ruled.u_scale * factor, ruled.v_scale * factor);
  std::vector<float> own;
  for (const float p : judged.probabilities) own.push_back(p >= judged.wall_from ? 1.0F : 0.0F);
  return expected_f(judged, cover.covered(walls)) >= kAsGood * expected_f(judged, own);
}

/// The lines by the model: walls and others; where somebody asked to keep a kind of lines, it stays.
DrawnLines labelled(const JudgedSheet& judged, const RuledLines& ruled, const DetectionOptions& chosen) {
  DrawnLines lines = label_lines(judged.sheet, judged.probabilities, ruled.drawn, ruled.u_scale,
                                 ruled.v_scale, judged.wall_from);
  const DetectionOptions options = resized(chosen, ruled.working.factor);
  const bool keeps = options.keep_furniture || options.keep_dashed || options.keep_dimensions;
  for (DrawnLine& line : lines) {
    const bool kept = keeps && !line.rejected && !line.pale;
    if (line.probability >= judged.wall_from || kept) {
      line.rejected.reset();
    } else if (!line.rejected) {
      line.rejected = RejectReason::Other;
    }
    if (options.min_wall_length_px && !line.rejected && line.length_px() < *options.min_wall_length_px)
      line.rejected = RejectReason::TooShort;
  }
  return lines;
}

}  // namespace

DetectedWalls detect_walls(const GrayImage& image, const DetectionOptions& chosen, const StageSink& sink,
                           const Progress& progress) {
  if (!chosen.is_valid()) throw Error("wall detection", chosen.why_invalid(), "correct the option");
  if (image.empty()) throw Error("wall detection", "the picture has no pixels", "import another drawing");
  DetectedWalls found;
  StageClock clock(found, sink, progress);
  RuledLines ruled = rule_lines(image, chosen, clock);

  clock.begin("label", 0.85);  // by the wall model, unless it finds the walls of the rules about as good
  const JudgedSheet judged = judge(image, chosen);
  const bool by_rules = rules_do(judged, ruled, chosen);
  DrawnLines drawn = by_rules ? std::move(ruled.drawn) : labelled(judged, ruled, chosen);
  clock.end(drawn.size());

  clock.begin("settle", 0.95);  // to a fraction of a pixel
  settle_lines(drawn, {image, ruled.u_scale, ruled.v_scale, ruled.working.bright_lines});
  found.walls = column_faces(ruled.cleaned, ruled.style);
  if (!by_rules) found.probabilities.assign(found.walls.size(), 1);
  found.rejected = std::move(ruled.cleaned.rejected);
  for (const DrawnLine& line : drawn) {
    if (line.rejected) {
      found.rejected.push_back({line.segment, *line.rejected, line.probability});
    } else {
      found.walls.push_back(line.segment);
      if (!by_rules) found.probabilities.push_back(line.probability);
    }
  }
  rescale(found, ruled.working.ink, image);
  found.skew_deg = measure_skew_deg(found.walls);
  if (chosen.straighten) straighten(found.walls, found.skew_deg);
  clock.end(found.walls.size());
  if (progress) progress("done", 1);
  return found;
}

}  // namespace madori::mapping
