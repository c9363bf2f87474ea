#include "mapping/drawing/raster/line_picture.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"
#include "mapping/drawing/raster/thinning.hpp"

namespace madori::mapping {
namespace {

constexpr int kBand = 64;  // rows that the cache holds at a time

}  // namespace

GrayImage line_picture(Strokes& strokes) {
  thin(strokes.thin, kPenLine);
  GrayImage lines = std::move(strokes.thin);
  cv::Mat picture = cv_view(lines);
  const cv::Mat solid = cv_view(strokes.solid);
  cv::Mat outline;
  const auto cross = cv::getStructuringElement(cv::MORPH_CROSS, {3, 3});
  for (int v = 0; v < picture.rows; v += kBand) {  // most bands hold no fill
    const cv::Range rows(v, std::min(v + kBand, picture.rows));
    const cv::Mat fill = solid.rowRange(rows);
    if (cv::countNonZero(fill) == 0) continue;
    cv::erode(fill, outline, cross);  // sees the rows around the band
    cv::subtract(fill, outline, outline);
    picture.rowRange(rows).setTo(cv::Scalar(kSolidFace), outline);
  }
  return lines;
}

}  // namespace madori::mapping
