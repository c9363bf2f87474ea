#include "mapping/drawing/raster/outer_faces.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"
#include "mapping/drawing/raster/line_fit.hpp"

namespace madori::mapping {
namespace {

constexpr int kCoarse = 1200;         // pixels of the coarse picture's longer side
constexpr double kEnclosed = 0.35;    // of the ink's box: less is no closed building
constexpr double kSampleShare = 0.8;  // of a line's samples that see the outside

/// 0 = ink, 255 = reached from the border of the picture, 128 = paper inside.
cv::Mat flooded(const GrayImage& ink, double shrink) {
  cv::Mat coarse;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(ink.width_px / shrink))),
                      std::max(1, static_cast<int>(std::lround(ink.height_px / shrink))));
  cv::resize(cv_view(ink), coarse, size, 0, 0, cv::INTER_AREA);
  cv::Mat paper;
  cv::copyMakeBorder(coarse, paper, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::threshold(paper, paper, 20, 128, cv::THRESH_BINARY_INV);
  cv::floodFill(paper, {0, 0}, cv::Scalar(255));
  return paper;
}

double enclosed_share(const cv::Mat& picture) {
  const cv::Mat inked = picture == 0;
  const cv::Rect box = cv::boundingRect(inked);
  if (box.area() == 0) return 0;
  return 1 - static_cast<double>(cv::countNonZero(picture(box) == 255)) / box.area();
}

}  // namespace

std::vector<bool> faces_outside(const DrawnLines& lines, const GrayImage& ink) {
  std::vector<bool> outside(lines.size(), false);
  const double shrink = std::max(1.0, static_cast<double>(std::max(ink.width_px, ink.height_px)) / kCoarse);
  const cv::Mat picture = flooded(ink, shrink);
  if (enclosed_share(picture) < kEnclosed) return outside;
  const double step_off = 2.5 * shrink;
  const auto sees = [&](double u, double v) {
    const int pu = std::clamp(static_cast<int>(u / shrink) + 1, 0, picture.cols - 1);
    const int pv = std::clamp(static_cast<int>(v / shrink) + 1, 0, picture.rows - 1);
    return picture.at<std::uint8_t>(pv, pu) == 255;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const PixelSegment& s = lines[i].segment;
    const FittedLine axis = line_through(s);
    const double du = -axis.direction_v * step_off, dv = axis.direction_u * step_off;
    int seen = 0;
    constexpr int kSamples = 9;
    for (int k = 0; k < kSamples; ++k) {
      const double t = (k + 0.5) / kSamples, u = std::lerp(s.u1, s.u2, t), v = std::lerp(s.v1, s.v2, t);
      seen += sees(u + du, v + dv) != sees(u - du, v - dv) ? 1 : 0;
    }
    outside[i] = seen >= kSampleShare * kSamples;
  }
  return outside;
}

}  // namespace madori::mapping
