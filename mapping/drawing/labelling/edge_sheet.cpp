#include "mapping/drawing/labelling/edge_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "mapping/drawing/labelling/straight_edges.hpp"
#include "mapping/drawing/raster/tones.hpp"
#include "mapping/picture/reduce.hpp"

namespace madori::mapping {
namespace {

constexpr double kSmallPixels = 2e6;  // below, the oracle's recall gains 0.01 to 0.05 by enlarging
constexpr double kMostPixels = 7e6;   // above, the detector alone would be slower than a Hough transform
constexpr double kShortest = 4;       // pixels: shorter edges are noise of the picture
constexpr double kShortestDrawn = 2;  // pixels of the drawing: so are these
constexpr double kBeside = 1.5;       // pixels off an edge its two sides show

/// The same drawing has about the same sheet however finely it is scanned.
double factor_for(const GrayImage& drawing) {
  const double pixels = static_cast<double>(drawing.width_px) * drawing.height_px;
  if (pixels > kMostPixels) return std::sqrt(kMostPixels / pixels);
  double factor = 1;
  while (pixels * factor * factor <= kSmallPixels) factor *= 2;
  return factor;
}

/// At `factor` times the size, its greys spread: of its few pixels before it grows, or of those that are
/// left.
GrayImage prepared(const GrayImage& image, const Tones& tones, double factor) {
  GrayImage out{.width_px = std::max(1, static_cast<int>(std::lround(image.width_px * factor))),
                .height_px = std::max(1, static_cast<int>(std::lround(image.height_px * factor))),
                .dpi = image.dpi * factor};
  const auto scale = [&](const cv::Mat& source, std::vector<std::uint8_t>& to, int finer) {
    to.resize(static_cast<std::size_t>(out.width_px) * static_cast<std::size_t>(out.height_px));
    cv::Mat target(out.height_px, out.width_px, CV_8UC1, to.data());
    cv::resize(source, target, target.size(), 0, 0, factor < 1 ? cv::INTER_AREA : finer);
  };
  const auto plane = [&](const std::vector<std::uint8_t>& levels) {
    return cv::Mat(image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(levels.data()));
  };
  const auto table = spread(tones);
  if (factor < 1) {
    out.pixels = reduced(image, table, out.width_px, out.height_px);
  } else {
    cv::Mat greys;
    cv::LUT(plane(image.pixels), table, greys);
    scale(greys, out.pixels, cv::INTER_CUBIC);
  }
  if (!image.red_green.empty()) scale(plane(image.red_green), out.red_green, cv::INTER_LINEAR);
  if (!image.yellow_blue.empty()) scale(plane(image.yellow_blue), out.yellow_blue, cv::INTER_LINEAR);
  return out;
}

/// Mean brightness along a segment, `off` pixels to its left.
double brightness(const EdgeSheet& sheet, const Edge& edge, double off) {
  const PixelSegment& s = edge.segment;
  const int samples = std::clamp(static_cast<int>(edge.length_px / 2), 3, 40);
  double sum = 0;
  int seen = 0;
  for (int k = 0; k < samples; ++k) {
    const double t = (k + 0.5) / samples;
    const double u = std::lerp(s.u1, s.u2, t) + off * edge.normal.x;
    const double v = std::lerp(s.v1, s.v2, t) + off * edge.normal.y;
    if (!sheet.inside(u, v)) continue;
    sum += sheet.grey.pixels[sheet.pixel(u, v)];
    ++seen;
  }
  return seen > 0 ? sum / seen : 0;
}

Edge edge_along(const EdgeSheet& sheet, const PixelSegment& segment) {
  Edge edge{.segment = segment, .length_px = segment.length_px()};
  edge.normal = {-(segment.v2 - segment.v1) / edge.length_px, (segment.u2 - segment.u1) / edge.length_px};
  if (brightness(sheet, edge, kBeside) > brightness(sheet, edge, -kBeside)) edge.normal = -edge.normal;
  const double angle = std::atan2(segment.v2 - segment.v1, segment.u2 - segment.u1);
  edge.angle_rad = std::fmod(angle + 2 * std::numbers::pi, std::numbers::pi);
  return edge;
}

void add_edges(EdgeSheet& sheet, std::vector<PixelSegment> segments) {
  const double shortest = std::max(kShortest, kShortestDrawn * sheet.factor);
  std::erase_if(segments, [&](const PixelSegment& s) { return s.length_px() < shortest; });
  sheet.edges.resize(segments.size());
  cv::parallel_for_({0, static_cast<int>(segments.size())}, [&](const cv::Range& some) {
    for (auto i = static_cast<std::size_t>(some.start); i < static_cast<std::size_t>(some.end); ++i)
      sheet.edges[i] = edge_along(sheet, segments[i]);
  });
  for (const PixelSegment& s : segments) sheet.box.add(s);
}

EdgeSheet::Ground ground_of(const GrayImage& picture) {
  const auto commonest = [](const std::vector<std::uint8_t>& plane) {
    return plane.empty() ? 128 : commonest_tone(tone_counts(plane));
  };
  return {commonest(picture.pixels), commonest(picture.red_green), commonest(picture.yellow_blue)};
}

/// Long edges are drawn last: they are what a ray meets where two share a pixel.
void draw_edges(EdgeSheet& sheet) {
  std::sort(sheet.edges.begin(), sheet.edges.end(), [](const Edge& a, const Edge& b) {
    return a.length_px != b.length_px
               ? a.length_px < b.length_px
               : std::pair(a.segment.u1, a.segment.v1) < std::pair(b.segment.u1, b.segment.v1);
  });
  sheet.map = EdgeMap(sheet.grey.width_px, sheet.grey.height_px);
  for (std::size_t i = 0; i < sheet.edges.size(); ++i)
    sheet.map.draw(sheet.edges[i].segment, static_cast<int>(i));
  sheet.map.measure_distances();
}

}  // namespace

EdgeSheet find_edges(const GrayImage& drawing) {
  EdgeSheet sheet;
  sheet.factor = factor_for(drawing);
  const Tones tones = tones_of(drawing);
  sheet.dark_ground = tones.dark_ground;
  sheet.grey = prepared(drawing, tones, sheet.factor);
  auto ground =
      std::async(std::launch::async, ground_of, std::cref(sheet.grey));  // the detector leaves a core
  add_edges(sheet, straight_edges(sheet.grey));
  sheet.ground = ground.get();
  draw_edges(sheet);
  return sheet;
}

}  // namespace madori::mapping
