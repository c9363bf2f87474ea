#include "mapping/drawing/labelling/edge_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/result.hpp"
#include "mapping/drawing/labelling/straight_edges.hpp"
#include "mapping/drawing/raster/cv_view.hpp"

namespace madori::mapping {
namespace {

constexpr double kSmallPixels = 2e6;  // below, the oracle's recall gains 0.01 to 0.05 by enlarging
constexpr double kMostPixels = 7e6;   // above, the detector alone would be slower than a Hough transform
constexpr double kShortest = 4;       // pixels: shorter edges are noise of the picture
constexpr double kShortestDrawn = 2;  // pixels of the drawing: so are these
constexpr double kBeside = 1.5;       // pixels off an edge its two sides show
constexpr double kRareTone = 1e-4;    // of the pixels: dust and glare do not say what is black and what white
constexpr int kLeastRange = 20;       // grey levels: an empty sheet stays as it is
constexpr int kRowsAsked = 1000;      // rows that are enough to tell the ground
constexpr int kStepShare = 8;         // of the range: what steps less is shading
constexpr double kNoise = 0.5;        // of the pixels are steps: white noise has 0.77, dense hatching 0.3

/// The same drawing has about the same sheet however finely it is scanned.
double factor_for(const GrayImage& drawing) {
  const double pixels = static_cast<double>(drawing.width_px) * drawing.height_px;
  if (pixels > kMostPixels) return std::sqrt(kMostPixels / pixels);
  double factor = 1;
  while (pixels * factor * factor <= kSmallPixels) factor *= 2;
  return factor;
}

/// The greys that a drawing uses, and which of them is its ground.
struct Tones {
  double darkest = 0, brightest = 255;
  bool dark_ground = false;
};

/// The ground is the commonest grey. It is dark where most steps from pixel to pixel lead to brighter greys.
Tones tones_of(const GrayImage& image) {
  cv::Mat counts;
  cv::calcHist(std::vector{cv_view(image)}, {0}, {}, counts, {256}, {0, 256});
  const double left_out = std::floor(kRareTone * static_cast<double>(image.pixels.size()));
  Tones tones;
  double below = 0, above = 0;
  int low = 0, high = 255;
  while ((below += counts.at<float>(low)) <= left_out) ++low;
  while ((above += counts.at<float>(high)) <= left_out) --high;
  if (high - low < kLeastRange) return tones;
  tones.darkest = low, tones.brightest = high;
  const auto ground =
      static_cast<int>(std::max_element(counts.begin<float>(), counts.end<float>()) - counts.begin<float>());
  std::size_t darker = 0, brighter = 0, asked = 0;
  for (int v = 0; v < image.height_px;
       v += 1 + image.height_px / kRowsAsked, asked += static_cast<std::size_t>(image.width_px))
    for (int u = 1; u < image.width_px; ++u) {
      const int one = image.at(u - 1, v), other = image.at(u, v);
      if (kStepShare * std::abs(one - other) < high - low) continue;
      const int off = std::abs(one - ground) > std::abs(other - ground) ? one : other;
      ++(off < ground ? darker : brighter);
    }
  if (static_cast<double>(darker + brighter) > kNoise * static_cast<double>(asked))
    throw Error("wall detection", "the picture is noise, no line can be told in it",
                "scan it again, or smooth it first");
  tones.dark_ground = brighter > darker;
  return tones;
}

/// The greys spread from black to white, the ground on the bright side: a CAD screen, a blueprint and a faint
/// scan are the same drawing as one in black on white.
std::array<std::uint8_t, 256> spread(const Tones& tones) {
  std::array<std::uint8_t, 256> table{};
  for (int grey = 0; grey < 256; ++grey) {
    double share = std::clamp((grey - tones.darkest) / (tones.brightest - tones.darkest), 0.0, 1.0);
    if (tones.dark_ground) share = 1 - share;
    table[static_cast<std::size_t>(grey)] = static_cast<std::uint8_t>(std::lround(255 * share));
  }
  return table;
}

/// At `factor` times the size, its greys spread: of its few pixels before it grows, or of those that are
/// left.
GrayImage prepared(const GrayImage& image, const Tones& tones, double factor) {
  GrayImage out{.width_px = std::max(1, static_cast<int>(std::lround(image.width_px * factor))),
                .height_px = std::max(1, static_cast<int>(std::lround(image.height_px * factor))),
                .dpi = image.dpi * factor};
  const auto scale = [&](std::vector<std::uint8_t> from, std::vector<std::uint8_t>& to, int finer) {
    if (from.empty()) return;
    const cv::Mat source(image.height_px, image.width_px, CV_8UC1, from.data());
    cv::Mat target;
    cv::resize(source, target, {out.width_px, out.height_px}, 0, 0, factor < 1 ? cv::INTER_AREA : finer);
    to.assign(target.datastart, target.dataend);
  };
  const auto table = spread(tones);
  auto greys = image.pixels;
  for (std::uint8_t& grey : greys) grey = table[grey];
  scale(std::move(greys), out.pixels, cv::INTER_CUBIC);
  scale(image.red_green, out.red_green, cv::INTER_LINEAR);
  scale(image.yellow_blue, out.yellow_blue, cv::INTER_LINEAR);
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

void append(EdgeSheet& sheet, const PixelSegment& segment) {
  Edge edge{.segment = segment, .length_px = segment.length_px()};
  if (edge.length_px < std::max(kShortest, kShortestDrawn * sheet.factor)) return;
  edge.normal = {-(segment.v2 - segment.v1) / edge.length_px, (segment.u2 - segment.u1) / edge.length_px};
  if (brightness(sheet, edge, kBeside) > brightness(sheet, edge, -kBeside)) edge.normal = -edge.normal;
  const double angle = std::atan2(segment.v2 - segment.v1, segment.u2 - segment.u1);
  edge.angle_rad = std::fmod(angle + 2 * std::numbers::pi, std::numbers::pi);
  sheet.edges.push_back(edge);
  sheet.box.add(segment);
}

/// Long edges are drawn last: they are what a ray meets where two share a pixel.
void draw_edges(EdgeSheet& sheet) {
  std::sort(sheet.edges.begin(), sheet.edges.end(), [](const Edge& a, const Edge& b) {
    return a.length_px != b.length_px
               ? a.length_px < b.length_px
               : std::pair(a.segment.u1, a.segment.v1) < std::pair(b.segment.u1, b.segment.v1);
  });
  const cv::Size size(sheet.grey.width_px, sheet.grey.height_px);
  sheet.edge_at.assign(sheet.grey.pixels.size(), -1);
  sheet.clear_px.resize(sheet.edge_at.size());
  cv::Mat numbers(size, CV_32SC1, sheet.edge_at.data()), free(size, CV_8UC1, cv::Scalar(255));
  for (std::size_t i = 0; i < sheet.edges.size(); ++i) {
    const PixelSegment& s = sheet.edges[i].segment;
    const auto at = [](double u, double v) {
      return cv::Point(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
    };
    cv::line(numbers, at(s.u1, s.v1), at(s.u2, s.v2), cv::Scalar(static_cast<double>(i)));
    cv::line(free, at(s.u1, s.v1), at(s.u2, s.v2), cv::Scalar(0));
  }
  cv::Mat clear(size, CV_32FC1, sheet.clear_px.data());
  cv::distanceTransform(free, clear, cv::DIST_L2, 3);
}

}  // namespace

EdgeSheet find_edges(const GrayImage& drawing) {
  EdgeSheet sheet;
  sheet.factor = factor_for(drawing);
  const Tones tones = tones_of(drawing);
  sheet.dark_ground = tones.dark_ground;
  sheet.grey = prepared(drawing, tones, sheet.factor);
  for (const PixelSegment& s : straight_edges(sheet.grey)) append(sheet, s);
  draw_edges(sheet);
  return sheet;
}

}  // namespace madori::mapping
