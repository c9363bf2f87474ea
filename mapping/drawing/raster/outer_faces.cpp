#include "mapping/drawing/raster/outer_faces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/skip_paper.hpp"

namespace madori::mapping {
namespace {

constexpr int kCoarse = 1200;          // pixels of the coarse picture's longer side
constexpr double kInked = 20.5 / 255;  // of a coarse cell: more is ink
constexpr double kEnclosed = 0.35;     // of the ink's box: less is no closed building
constexpr double kTwoSided = 1.3;      // of a line's length is paired: it has walls on both sides
constexpr double kBehind = 0.8;        // of the length of cladding: a line along so much of it is the wall
constexpr double kSameStroke = 0.75;   // pixels
constexpr double kSampleShare = 0.8;   // of a line's samples that see the outside

/// The coarse cell that a pixel begins in, and how much of the pixel lies in the next one.
struct Share {
  int cell = 0;
  float beyond = 0;
};

std::vector<Share> shares(int pixels, int cells) {
  std::vector<Share> found(static_cast<std::size_t>(pixels));
  const double cell_px = static_cast<double>(pixels) / cells;
  for (int i = 0; i < pixels; ++i) {
    const int cell = std::min(static_cast<int>(i / cell_px), cells - 1);
    const double beyond = cell + 1 < cells ? std::clamp(i + 1 - (cell + 1) * cell_px, 0.0, 1.0) : 0;
    found[static_cast<std::size_t>(i)] = {cell, static_cast<float>(beyond)};
  }
  return found;
}

/// How many pixels of ink each coarse cell holds: an area average whose work follows the ink.
cv::Mat ink_in_cells(const GrayImage& ink, const cv::Size& size) {
  cv::Mat sums(size, CV_32FC1, cv::Scalar(0));
  const auto across = shares(ink.width_px, size.width), down = shares(ink.height_px, size.height);
  for (int v = 0; v < ink.height_px; ++v) {
    const Share& row = down[static_cast<std::size_t>(v)];
    auto* here = sums.ptr<float>(row.cell);
    auto* below = sums.ptr<float>(std::min(row.cell + 1, size.height - 1));
    const std::uint8_t* pixels =
        &ink.pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(ink.width_px)];
    const auto width = static_cast<std::size_t>(ink.width_px);
    for (std::size_t u = skip_paper(pixels, 0, width); u < width; u = skip_paper(pixels, u + 1, width)) {
      const Share& column = across[u];
      const int next = std::min(column.cell + 1, size.width - 1);
      here[column.cell] += (1 - row.beyond) * (1 - column.beyond);
      here[next] += (1 - row.beyond) * column.beyond;
      below[column.cell] += row.beyond * (1 - column.beyond);
      below[next] += row.beyond * column.beyond;
    }
  }
  return sums;
}

/// 0 = ink, 255 = reached from the border of the picture, 128 = paper inside.
cv::Mat flooded(const GrayImage& ink, double shrink) {
  const cv::Size size(std::max(1, static_cast<int>(std::lround(ink.width_px / shrink))),
                      std::max(1, static_cast<int>(std::lround(ink.height_px / shrink))));
  const double cell_px2 = static_cast<double>(ink.width_px) * ink.height_px / size.area();
  cv::Mat coarse, paper;
  cv::threshold(ink_in_cells(ink, size), coarse, kInked * cell_px2, 128, cv::THRESH_BINARY_INV);
  coarse.convertTo(coarse, CV_8U);
  cv::copyMakeBorder(coarse, paper, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(128));
  cv::floodFill(paper, {0, 0}, cv::Scalar(255));
  return paper;
}

double enclosed_share(const cv::Mat& picture) {
  const cv::Mat inked = picture == 0;
  const cv::Rect box = cv::boundingRect(inked);
  if (box.area() == 0) return 0;
  return 1 - static_cast<double>(cv::countNonZero(picture(box) == 255)) / box.area();
}

/// Whether the ray from (u, v) in direction (du, dv) meets a wall.
bool hits_wall(std::size_t self, const DrawnLines& lines, double u, double v, double du, double dv) {
  for (std::size_t j = 0; j < lines.size(); ++j) {
    if (j == self || lines[j].rejected) continue;
    const PixelSegment& s = lines[j].segment;
    const double a = (s.u1 - u) * dv - (s.v1 - v) * du, b = (s.u2 - u) * dv - (s.v2 - v) * du;
    if ((a > 0) == (b > 0)) continue;
    const double t = a / (a - b);
    if ((std::lerp(s.u1, s.u2, t) - u) * du + (std::lerp(s.v1, s.v2, t) - v) * dv > 1) return true;
  }
  return false;
}

/// One side of the line looks straight out of the drawing all along, the other meets walls all along.
bool looks_out(std::size_t self, const DrawnLines& lines) {
  const PixelSegment& s = lines[self].segment;
  const FittedLine axis = line_through(s);
  int left = 0, right = 0;
  constexpr int kSamples = 5;
  for (int k = 0; k < kSamples; ++k) {
    const double t = (k + 0.5) / kSamples, u = std::lerp(s.u1, s.u2, t), v = std::lerp(s.v1, s.v2, t);
    left += hits_wall(self, lines, u, v, axis.direction_v, -axis.direction_u) ? 1 : 0;
    right += hits_wall(self, lines, u, v, -axis.direction_v, axis.direction_u) ? 1 : 0;
  }
  return std::min(left, right) == 0 && std::max(left, right) == kSamples;
}

/// The same stroke on the same straight line as a longer one that is `outside`, with no more than a pillar or
/// a joint between.
bool continues_facade(std::size_t self, const DrawnLines& lines, const std::vector<bool>& outside,
                      double gap_px) {
  const DrawnLine& own = lines[self];
  if (own.solid_face) return false;
  const FittedLine axis = line_through(own.segment);
  for (std::size_t j = 0; j < lines.size(); ++j) {
    const DrawnLine& other = lines[j];
    if (!outside[j] || other.solid_face || other.length_px() < own.length_px()) continue;
    if (std::abs(other.stroke_px - own.stroke_px) > kSameStroke) continue;
    const PixelSegment& s = other.segment;
    const double a = axis.along(s.u1, s.v1), b = axis.along(s.u2, s.v2);
    const double gap = std::max(std::min(a, b), -std::max(a, b)) - 0.5 * own.length_px();
    if (std::abs(gap) <= gap_px && std::abs(axis.across(s.u1, s.v1)) <= own.stroke_px &&
        std::abs(axis.across(s.u2, s.v2)) <= own.stroke_px)
      return true;
  }
  return false;
}

}  // namespace

std::vector<bool> faces_outside(const DrawnLines& lines, const std::vector<bool>& asked,
                                const GrayImage& ink) {
  std::vector<bool> outside(lines.size(), false);
  if (std::find(asked.begin(), asked.end(), true) == asked.end()) return outside;
  const double shrink = std::max(1.0, static_cast<double>(std::max(ink.width_px, ink.height_px)) / kCoarse);
  const cv::Mat picture = flooded(ink, shrink);
  const bool closed = enclosed_share(picture) >= kEnclosed;
  const double step_off = 2.5 * shrink;
  const auto sees = [&](double u, double v) {
    const int pu = std::clamp(static_cast<int>(u / shrink) + 1, 0, picture.cols - 1);
    const int pv = std::clamp(static_cast<int>(v / shrink) + 1, 0, picture.rows - 1);
    return picture.at<std::uint8_t>(pv, pu) == 255;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!asked[i]) continue;
    const PixelSegment& s = lines[i].segment;
    const FittedLine axis = line_through(s);
    const double du = -axis.direction_v * step_off, dv = axis.direction_u * step_off;
    int seen = 0;
    constexpr int kSamples = 9;
    for (int k = 0; k < kSamples; ++k) {
      const double t = (k + 0.5) / kSamples, u = std::lerp(s.u1, s.u2, t), v = std::lerp(s.v1, s.v2, t);
      seen += sees(u + du, v + dv) != sees(u - du, v - dv) ? 1 : 0;
    }
    outside[i] = (closed && seen >= kSampleShare * kSamples) || (!lines[i].rejected && looks_out(i, lines));
  }
  return outside;
}

std::vector<bool> spare_faces(const DrawnLines& lines, const std::vector<Strip>& strips,
                              const WallStyle& style) {
  std::vector<double> beside(lines.size(), 0), behind(lines.size(), 0);
  const double widest = std::max(style.widest_empty_px, style.widest_filled_px);
  const auto is_wall = [&](std::size_t i) { return !lines[i].rejected; };
  for (const Strip& strip : strips)
    if (strip.width_px <= widest && is_wall(strip.line) && is_wall(strip.partner))
      beside[strip.line] += strip.length_px();
  for (const Strip& strip : strips) {
    if (strip.width_px > widest || !is_wall(strip.partner)) continue;
    const double partner = lines[strip.partner].length_px();
    if (beside[strip.partner] > kTwoSided * partner) behind[strip.line] += strip.length_px();
  }
  std::vector<bool> spare(lines.size(), false);
  for (std::size_t i = 0; i < lines.size(); ++i)
    spare[i] = lines[i].solid_face || behind[i] > 0.5 * lines[i].length_px();
  return spare;
}

std::vector<bool> cladding(const DrawnLines& lines, const std::vector<bool>& outside,
                           const std::vector<Strip>& strips, const WallStyle& style) {
  std::vector<double> lost(lines.size(), 0), hidden(lines.size(), 0);
  const double widest = std::max(style.widest_empty_px, style.widest_filled_px);
  for (const Strip& strip : strips) {
    if (strip.width_px > widest || lines[strip.line].rejected) continue;
    if (outside[strip.partner] && lines[strip.line].solid_face && lines[strip.partner].solid_face)
      lost[strip.line] += strip.length_px();
    if (!lines[strip.partner].rejected &&
        lines[strip.partner].length_px() > kBehind * lines[strip.line].length_px())
      hidden[strip.line] += strip.length_px();
  }
  std::vector<bool> clad(lines.size(), false);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double enough = kBehind * lines[i].length_px();
    const bool facade =
        (lost[i] > enough && hidden[i] > enough) || continues_facade(i, lines, outside, widest);
    clad[i] = facade && !lines[i].rejected && looks_out(i, lines);
  }
  return clad;
}

}  // namespace madori::mapping
