#include "mapping/drawing/import_picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace madori::mapping {
namespace {

const cv::Scalar kWall(150, 50, 0);        // BGR: deep blue
const cv::Scalar kRejected(40, 140, 255);  // orange
const cv::Scalar kInk(40, 40, 40);
constexpr int kFooter = 64;
constexpr int kFractionBits = 4;

cv::Mat pale(const GrayImage& drawing, double zoom) {
  const cv::Mat gray(drawing.height_px, drawing.width_px, CV_8UC1,
                     const_cast<std::uint8_t*>(drawing.pixels.data()));
  cv::Mat small;
  cv::resize(gray, small, {}, zoom, zoom, cv::INTER_AREA);
  small.convertTo(small, CV_8UC1, 0.35, 255.0 * 0.65);
  cv::Mat colour;
  cv::cvtColor(small, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

cv::Point at(double u, double v, double zoom) {
  const double fine = zoom * (1 << kFractionBits);
  const double half = 0.5 * (1 << kFractionBits);
  return {static_cast<int>(std::lround(u * fine - half)), static_cast<int>(std::lround(v * fine - half))};
}

void draw(cv::Mat& picture, const PixelSegment& s, double zoom, const cv::Scalar& colour, int thickness) {
  cv::line(picture, at(s.u1, s.v1, zoom), at(s.u2, s.v2, zoom), colour, thickness, cv::LINE_AA,
           kFractionBits);
}

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

void draw_footer(cv::Mat& picture, double zoom, std::optional<double> m_per_px) {
  const int width = picture.cols;
  const int base = picture.rows - kFooter / 2;
  const auto label = [&](const std::string& text, int x) {
    cv::putText(picture, text, {x, base + 7}, cv::FONT_HERSHEY_SIMPLEX, 0.65, kInk, 1, cv::LINE_AA);
  };
  cv::line(picture, {20, base}, {60, base}, kWall, 4, cv::LINE_AA);
  label("wall", 70);
  cv::line(picture, {150, base}, {190, base}, kRejected, 1, cv::LINE_AA);
  label("not a wall", 200);
  if (!m_per_px) {
    label("unscaled: no length is known yet", std::max(340, width - 420));
    return;
  }
  const double metres = round_length(0.2 * width * *m_per_px / zoom);
  const int bar = static_cast<int>(std::lround(metres / *m_per_px * zoom));
  const int right = width - 30;
  cv::rectangle(picture, {right - bar, base + 4}, {right, base + 10}, kInk, cv::FILLED);
  cv::putText(picture, length_text(metres), {right - bar, base - 4}, cv::FONT_HERSHEY_SIMPLEX, 0.65, kInk, 1,
              cv::LINE_AA);
}

}  // namespace

std::vector<std::uint8_t> import_picture(const GrayImage& drawing, std::span<const PixelSegment> walls,
                                         std::span<const RejectedSegment> rejected,
                                         std::optional<double> m_per_px, int widest_px) {
  const double zoom = std::clamp(static_cast<double>(widest_px) / drawing.width_px, 1e-3,
                                 std::max(1.0, 900.0 / drawing.width_px));
  cv::Mat picture = pale(drawing, zoom);
  cv::copyMakeBorder(picture, picture, 0, kFooter, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(255, 255, 255));
  for (const auto& line : rejected) draw(picture, line.segment, zoom, kRejected, 1);
  const int bold = std::max(2, picture.cols / 600);
  for (const auto& wall : walls) draw(picture, wall, zoom, kWall, bold);
  draw_footer(picture, zoom, m_per_px);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png, {cv::IMWRITE_PNG_COMPRESSION, 1});
  return png;
}

}  // namespace madori::mapping
