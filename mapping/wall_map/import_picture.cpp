#include "mapping/wall_map/import_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "mapping/wall_map/palette_png.hpp"
#include "mapping/wall_map/skip_paper.hpp"

namespace madori::mapping {
namespace {

constexpr int kWidestPicture = 2400;
constexpr int kFooter = 64;
constexpr int kFooterWidth = 800;  // its words need that much
constexpr int kFractionBits = 4;
constexpr int kSmallest = 900;
constexpr double kFaintest = 0.5;  // of the full colour: a line of no probability is still seen

/// The picture's colours: sixteen shades of each family. Few colours keep the file small and quick to pack.
constexpr int kShades = 16;
enum Family { Paper = 0, Rejected = 1, Accepted = 2, Ink = 3 };
constexpr std::array<std::array<int, 3>, 4> kFullColour{
    {{165, 165, 165}, {255, 140, 40}, {0, 50, 150}, {40, 40, 40}}};  // RGB

/// Shade 15 is the full colour, shade 0 white; of paper 0 is the darkest pale ink and 15 white.
std::vector<PaletteColour> palette() {
  std::vector<PaletteColour> colours;
  for (std::size_t family = 0; family < kFullColour.size(); ++family)
    for (int shade = 0; shade < kShades; ++shade) {
      const int strength = family == Paper ? kShades - 1 - shade : shade;
      PaletteColour colour{};
      for (std::size_t i = 0; i < 3; ++i)
        colour[i] =
            static_cast<std::uint8_t>(255 - strength * (255 - kFullColour[family][i]) / (kShades - 1));
      colours.push_back(colour);
    }
  return colours;
}

/// The drawing reduced by a whole number (or enlarged where it is tiny), with a footer, as shades of paper.
/// Paper that is not quite white becomes white: its noise would be most of the file.
cv::Mat pale(const GrayImage& drawing, int shrink, int enlarge) {
  const cv::Mat gray(drawing.height_px, drawing.width_px, CV_8UC1,
                     const_cast<std::uint8_t*>(drawing.pixels.data()));
  const cv::Size size(std::max(1, drawing.width_px * enlarge / shrink),
                      std::max(1, drawing.height_px * enlarge / shrink));
  cv::Mat picture(size.height + kFooter, std::max(size.width, kFooterWidth), CV_8UC1, cv::Scalar(255));
  cv::Mat drawn = picture(cv::Rect({0, 0}, size));
  const cv::Rect whole(0, 0, std::min(drawing.width_px, std::max(1, size.width * shrink / enlarge)),
                       std::min(drawing.height_px, std::max(1, size.height * shrink / enlarge)));
  cv::resize(gray(whole), drawn, size, 0, 0, enlarge > 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  cv::Mat shades(1, 256, CV_8UC1);
  for (int level = 0; level < 256; ++level)
    shades.at<std::uint8_t>(level) = static_cast<std::uint8_t>(std::min(kShades - 1, level * kShades / 224));
  cv::LUT(picture, shades, picture);
  return picture;
}

/// Draws strokes on a sheet of their own and lays it over the picture in the family's colour.
class Layer {
 public:
  Layer(cv::Mat& picture, double zoom)
      : picture_(picture), sheet_(picture.size(), CV_8UC1, cv::Scalar(0)), zoom_(zoom) {}

  /// The surer, the stronger.
  void line(const PixelSegment& s, int thickness, double probability) {
    cv::line(sheet_, at(s.u1, s.v1), at(s.u2, s.v2), 255 * std::lerp(kFaintest, 1.0, probability), thickness,
             cv::LINE_AA, kFractionBits);
  }
  cv::Mat& sheet() { return sheet_; }

  void lay(Family family) { lay(family, 0); }
  void lay_footer(Family family) { lay(family, picture_.rows - kFooter); }

 private:
  [[nodiscard]] cv::Point at(double u, double v) const {
    const double fine = zoom_ * (1 << kFractionBits);
    const double half = 0.5 * (1 << kFractionBits);
    return {static_cast<int>(std::lround(u * fine - half)), static_cast<int>(std::lround(v * fine - half))};
  }

  /// From row `top` on, where all that was drawn must lie.
  void lay(Family family, int top) {
    for (int v = top; v < picture_.rows; ++v) {
      auto* below = picture_.ptr<std::uint8_t>(v);
      auto* ink = sheet_.ptr<std::uint8_t>(v);
      const auto width = static_cast<std::size_t>(picture_.cols);
      for (std::size_t u = skip_paper(ink, 0, width); u < width; u = skip_paper(ink, u + 1, width)) {
        if (ink[u] >= 256 / kShades)
          below[u] = static_cast<std::uint8_t>(family * kShades + ink[u] * kShades / 256);
        ink[u] = 0;
      }
    }
  }

  cv::Mat& picture_;
  cv::Mat sheet_;
  double zoom_;
};

/// 1, 2 or 5 times a power of ten, the largest that is at most `most`.
double round_length(double most) {
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= most) return step * decade;
  return decade;
}

std::string length_text(double metres) {
  std::string text = std::to_string(metres);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " m";
}

void write_text(cv::Mat& sheet, const std::string& text, int x, int y) {
  cv::putText(sheet, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.65, 255, 1, cv::LINE_AA);
}

void draw_footer(Layer& layer, double zoom, std::optional<double> m_per_px) {
  cv::Mat& sheet = layer.sheet();
  const int base = sheet.rows - kFooter / 2;
  cv::line(sheet, {20, base}, {60, base}, 255, 4, cv::LINE_AA);
  layer.lay_footer(Accepted);
  cv::line(sheet, {150, base}, {190, base}, 255, 2, cv::LINE_AA);
  layer.lay_footer(Rejected);
  write_text(sheet, "wall", 70, base + 7);
  write_text(sheet, "not a wall", 200, base + 7);
  if (m_per_px) {
    const double metres = round_length(0.2 * sheet.cols * *m_per_px / zoom);
    const int bar = static_cast<int>(std::lround(metres / *m_per_px * zoom));
    const int right = sheet.cols - 30;
    cv::rectangle(sheet, {right - bar, base + 4}, {right, base + 10}, 255, cv::FILLED);
    write_text(sheet, length_text(metres), right - bar, base - 4);
  } else {
    write_text(sheet, "unscaled: no length is known yet", std::max(340, sheet.cols - 420), base + 7);
  }
  layer.lay_footer(Ink);
}

}  // namespace

PixelSegment on_drawing(const Segment2<Map>& line, int height_px, double m_per_px) {
  return {line.a.x_m / m_per_px, height_px - line.a.y_m / m_per_px, line.b.x_m / m_per_px,
          height_px - line.b.y_m / m_per_px};
}

std::vector<std::uint8_t> import_picture(const GrayImage& drawing, std::span<const PixelSegment> walls,
                                         std::span<const RejectedSegment> rejected,
                                         std::optional<double> m_per_px,
                                         std::span<const double> probabilities) {
  const int longer = std::max(drawing.width_px, drawing.height_px);
  const int shrink = (longer + kWidestPicture - 1) / kWidestPicture;
  const int enlarge = std::max(1, kSmallest / longer);
  const double zoom = static_cast<double>(enlarge) / shrink;
  cv::Mat picture = pale(drawing, shrink, enlarge);
  Layer layer(picture, zoom);
  for (const auto& line : rejected) layer.line(line.segment, 1, line.probability);
  layer.lay(Rejected);
  const int bold = std::max(2, picture.cols / 600);
  for (std::size_t i = 0; i < walls.size(); ++i)
    layer.line(walls[i], bold, probabilities.empty() ? 1 : probabilities[i]);
  layer.lay(Accepted);
  draw_footer(layer, zoom, m_per_px);
  return palette_png(picture.cols, picture.rows, {picture.data, picture.total()}, palette());
}

}  // namespace madori::mapping
