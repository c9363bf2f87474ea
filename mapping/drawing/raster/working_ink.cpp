#include "mapping/drawing/raster/working_ink.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/binarize.hpp"
#include "mapping/drawing/raster/cv_view.hpp"
#include "mapping/drawing/raster/strokes.hpp"

namespace madori::mapping {
namespace {

constexpr std::size_t kSampleStep = 31;  // every so many pixels tell the ground
constexpr std::size_t kInkShare = 100;   // one pixel in so many is a line at least
constexpr std::size_t kGroundShare = 3;  // lines and fills cover less than a third
constexpr int kLeastContrast = 40;       // grey levels between the ground and the lines
constexpr double kCoarsePen = 4.5, kFinePen = 1.42;
constexpr double kGoodPen = 2.5;
constexpr double kMostToEnlarge = 6e6;                     // pixels
constexpr double kSmall = 2.5e6;                           // pixels: to enlarge them costs little
constexpr double kWidestPen = 6, kWidestPenShare = 0.002;  // thicker strokes are fills, whatever is commonest

/// Dark lines on bright paper; nothing where they are that already.
std::optional<GrayImage> dark_on_bright(const GrayImage& image) {
  std::array<std::size_t, 256> counts{};
  std::size_t total = 0;
  for (std::size_t at = 0; at < image.pixels.size(); at += kSampleStep, ++total) ++counts[image.pixels[at]];
  const auto level_at = [&](std::size_t rank) {
    std::size_t seen = 0, level = 0;
    while (level < 255 && (seen += counts[level]) <= rank) ++level;
    return static_cast<int>(level);
  };
  const int dark = level_at(total / kInkShare), bright = level_at(total - 1 - total / kInkShare);
  const int ground = level_at(total - 1 - total / kGroundShare);
  if (bright - ground < kLeastContrast || bright - ground < ground - dark) return std::nullopt;
  GrayImage turned = image;
  for (auto& pixel : turned.pixels) pixel = static_cast<std::uint8_t>(255 - pixel);
  return turned;
}

double widest_pen_px(const GrayImage& image) {
  return std::max(kWidestPen, kWidestPenShare * std::max(image.width_px, image.height_px));
}

/// By how much to resize a drawing with this pen; 1 = leave it, also where it has fills instead of a pen.
double working_factor(const GrayImage& image, double pen_px) {
  if (pen_px > kCoarsePen && pen_px < widest_pen_px(image)) return 1 / std::round(pen_px / kGoodPen);
  const double pixels = static_cast<double>(image.width_px) * image.height_px;
  const double fine = pixels <= kSmall ? kGoodPen : kFinePen;
  return pen_px < fine && pixels <= kMostToEnlarge ? 2 : 1;
}

GrayImage resized(const GrayImage& image, double factor) {
  const auto scaled = [factor](int size) {
    return std::max(1, static_cast<int>(std::lround(size * factor)));
  };
  GrayImage out{scaled(image.width_px), scaled(image.height_px), {}, image.dpi * factor};
  out.pixels.resize(static_cast<std::size_t>(out.width_px) * static_cast<std::size_t>(out.height_px));
  cv::Mat picture = cv_view(out);
  cv::resize(cv_view(image), picture, picture.size(), 0, 0, factor < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  return out;
}

WorkingInk inked(const GrayImage& image, Binarized binary, double factor) {
  Components marks(binary.ink);
  const double pen_px = std::min(pen_width_px(run_lengths(binary.ink, marks)), widest_pen_px(image));
  return {std::move(binary.ink), std::move(marks), pen_px, factor, binary.threshold, false};
}

}  // namespace

WorkingInk working_ink(const GrayImage& drawing, std::optional<double> threshold) {
  const auto turned = dark_on_bright(drawing);
  const GrayImage& picture = turned ? *turned : drawing;
  WorkingInk working = inked(picture, binarize(picture, threshold), 1);
  const double factor = working_factor(picture, working.pen_px);
  if (factor != 1) {
    const GrayImage other = resized(picture, factor);
    const bool enlarged = factor > 1 && !threshold;
    working = inked(
        other, enlarged ? binarize_enlarged(other, working.threshold) : binarize(other, threshold), factor);
  }
  working.bright_lines = turned.has_value();
  return working;
}

DetectionOptions resized(DetectionOptions options, double factor) {
  for (auto* length : {&options.min_wall_length_px, &options.min_thickness_px, &options.close_gap_px})
    if (*length) **length *= factor;
  if (options.m_per_px) *options.m_per_px /= factor;
  return options;
}

void rescale(DetectedWalls& found, const GrayImage& from, const GrayImage& to) {
  const double u = static_cast<double>(to.width_px) / from.width_px;
  const double v = static_cast<double>(to.height_px) / from.height_px;
  const auto back = [u, v](PixelSegment& s) { s = {s.u1 * u, s.v1 * v, s.u2 * u, s.v2 * v}; };
  for (PixelSegment& wall : found.walls) back(wall);
  for (RejectedSegment& rejected : found.rejected) back(rejected.segment);
}

}  // namespace madori::mapping
