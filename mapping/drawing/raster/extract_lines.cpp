#include "mapping/drawing/raster/extract_lines.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/drawing/raster/hough_seeds.hpp"
#include "mapping/drawing/raster/line_picture.hpp"
#include "mapping/drawing/raster/merge_lines.hpp"
#include "mapping/drawing/raster/refine_lines.hpp"
#include "mapping/drawing/raster/stroke_width.hpp"
#include "mapping/drawing/raster/strokes.hpp"
#include "mapping/drawing/raster/trace_chains.hpp"

namespace madori::mapping {
namespace {

constexpr double kShortestInPens = 6, kShortest = 10;
constexpr double kBendInPens = 0.6, kBend = 1;  // how far a chain may miss its pixels
constexpr std::size_t kFewestPixels = 4;
constexpr double kGapInPens = 2, kGap = 4;

double length_of(const Chain& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.corners.size(); ++i)
    length +=
        std::hypot(chain.corners[i].u - chain.corners[i - 1].u, chain.corners[i].v - chain.corners[i - 1].v);
  return length;
}

void append_chains(DrawnLines& drawn, const std::vector<Chain>& chains, double shortest_px) {
  int number = 0;
  for (const Chain& chain : chains) {
    if (length_of(chain) < shortest_px) continue;
    for (std::size_t i = 1; i < chain.corners.size(); ++i) {
      DrawnLine line;
      line.segment = {chain.corners[i - 1].u, chain.corners[i - 1].v, chain.corners[i].u, chain.corners[i].v};
      line.solid_face = chain.solid_face;
      line.chain = number;
      drawn.push_back(line);
    }
    ++number;
  }
}

}  // namespace

DrawnLines extract_lines(const GrayImage& ink, const Components& marks, double pen_px,
                         const DetectionOptions& options, StageClock& clock) {
  clock.begin("strokes", 0.3);
  const double solid_px = options.min_thickness_px.value_or(solid_from_px(run_lengths(ink, marks), pen_px));
  Strokes strokes = split_strokes(ink, solid_px);
  clock.picture("solid", strokes.solid);
  GrayImage lines = line_picture(strokes);
  clock.picture("lines", lines);
  clock.end(static_cast<std::size_t>(solid_px));
  clock.begin("hough", 0.5);
  const double shortest = std::max(kShortest, kShortestInPens * pen_px);
  const auto seeds = hough_seeds(lines, shortest);
  clock.end(seeds.size());
  clock.begin("fit", 0.7);
  DrawnLines drawn = refine_lines(lines, seeds, {.shortest_px = shortest});
  clock.end(drawn.size());
  clock.begin("chains", 0.75);
  append_chains(drawn, trace_chains(lines, std::max(kBend, kBendInPens * pen_px), kFewestPixels), shortest);
  clock.end(drawn.size());
  clock.begin("merge", 0.8);
  const double gap = options.close_gap_px.value_or(std::max(kGap, kGapInPens * pen_px));
  drawn = merge_lines(std::move(drawn), {.largest_gap_px = gap});
  measure_strokes(drawn, ink);
  clock.end(drawn.size());
  return drawn;
}

}  // namespace madori::mapping
