#include "mapping/drawing/raster/strokes.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"

namespace madori::mapping {
namespace {

constexpr int kLongestRun = 64;
constexpr double kLeastSolid = 4, kMostSolid = 8;  // pixels
constexpr double kLeastPens = 1.5, kMostPens = 4;
constexpr double kPeak = 2.5;            // times the emptiest thickness below it
constexpr double kPeakShare = 0.2;       // of the pen's peak
constexpr double kFinerPenShare = 0.25;  // of the commonest run length
constexpr int kColumnStep = 19;          // a sample of the columns is enough
constexpr int kBand = 128;               // rows that the cache holds at a time

/// Ink down a column: its length and the row after it.
struct Stretch {
  int length = 0, end = 0;
};

/// Runs down every so many columns, out of the runs across.
void count_down(const GrayImage& ink, const Components& marks, RunLengths& runs) {
  std::vector<Stretch> columns(static_cast<std::size_t>(ink.width_px / kColumnStep) + 1);
  const auto count = [&](const Stretch& stretch) {
    if (stretch.length > 0 && stretch.length <= kLongestRun && stretch.end < ink.height_px)
      runs[static_cast<std::size_t>(stretch.length)] += kColumnStep;
  };
  for (const Run& run : marks.runs()) {
    for (int i = (run.first + kColumnStep - 1) / kColumnStep; i * kColumnStep <= run.last; ++i) {
      Stretch& stretch = columns[static_cast<std::size_t>(i)];
      if (stretch.end != run.v) {
        count(stretch);
        stretch.length = 0;
      }
      ++stretch.length;
      stretch.end = run.v + 1;
    }
  }
  for (const Stretch& stretch : columns) count(stretch);
}

cv::Mat box_of(int radius) {
  return cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
}

/// Erodes by a disc of the radius: a box, the rest diamonds.
void shrink(cv::Mat& picture, int radius) {
  const int box = static_cast<int>(std::lround(radius * 0.41));
  if (box > 0) cv::erode(picture, picture, box_of(box));
  if (radius > box)
    cv::erode(picture, picture, cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}), {-1, -1}, radius - box);
}

}  // namespace

RunLengths run_lengths(const GrayImage& ink, const Components& marks) {
  RunLengths runs(kLongestRun + 2, 0);
  for (const Run& run : marks.runs())
    if (run.length() <= kLongestRun) runs[static_cast<std::size_t>(run.length())] += 1;
  count_down(ink, marks, runs);
  return runs;
}

double pen_width_px(const RunLengths& runs) {
  const auto around = [&](std::size_t i) { return runs[i - 1] + runs[i] + runs[i + 1]; };
  std::size_t commonest = 1;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i)
    if (runs[i] > runs[commonest]) commonest = i;
  std::size_t pen = commonest;  // or a finer one: solid walls may outweigh all that is drawn with the pen
  for (std::size_t i = commonest; i-- > 1;)
    if (runs[i] > runs[i - 1] && runs[i] > runs[i + 1] && runs[i] >= kFinerPenShare * runs[commonest])
      pen = i;
  if (around(pen) <= 0) return 1;
  return static_cast<double>(pen) + (runs[pen + 1] - runs[pen - 1]) / around(pen);
}

double solid_from_px(const RunLengths& runs, double pen_px) {
  const auto around = [&](std::size_t i) { return runs[i - 1] + runs[i]; };
  const auto first = static_cast<std::size_t>(std::ceil(std::max(kLeastSolid, kLeastPens * pen_px)));
  const auto last = static_cast<std::size_t>(std::max(kMostSolid, kMostPens * pen_px));
  double pen = 0;
  for (std::size_t i = 1; i < first; ++i) pen = std::max(pen, around(i));
  std::size_t best = first;
  for (std::size_t i = first; i <= std::min(last, runs.size() - 2); ++i) {
    if (around(i) > kPeak * around(best) && around(i) > kPeakShare * pen) break;  // thin walls begin here
    if (around(i) < 0.9 * around(best)) best = i;
  }
  return static_cast<double>(best);
}

Strokes split_strokes(const GrayImage& ink, double solid_from_px) {
  Strokes strokes{blank_like(ink), ink, solid_from_px};
  const cv::Mat all = cv_view(ink);
  cv::Mat solid = cv_view(strokes.solid), thin = cv_view(strokes.thin), part;
  const int radius = std::max(1, static_cast<int>((strokes.solid_from_px - 1) / 2));
  const int grown = radius + 2;  // two more: the ragged rim belongs to the fill
  for (int v = 0; v < ink.height_px; v += kBand) {
    const cv::Range rows(v, std::min(v + kBand, ink.height_px));
    const int top = std::max(0, v - radius - grown);
    all.rowRange(top, std::min(rows.end + radius + grown, ink.height_px)).copyTo(part);
    shrink(part, radius);
    if (cv::countNonZero(part) == 0) continue;
    cv::dilate(part, part, box_of(grown));
    cv::bitwise_and(part.rowRange(v - top, rows.end - top), all.rowRange(rows), solid.rowRange(rows));
    cv::subtract(all.rowRange(rows), solid.rowRange(rows), thin.rowRange(rows));
  }
  return strokes;
}

}  // namespace madori::mapping
