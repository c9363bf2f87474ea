#include "mapping/drawing/raster/line_picture.hpp"

#include <opencv2/imgproc.hpp>

#include "mapping/drawing/raster/cv_view.hpp"
#include "mapping/drawing/raster/thinning.hpp"

namespace madori::mapping {

GrayImage line_picture(Strokes& strokes) {
  thin(strokes.thin);
  GrayImage lines = std::move(strokes.thin);
  cv::Mat picture = cv_view(lines);
  cv::bitwise_and(picture, cv::Scalar(kPenLine), picture);
  const cv::Mat solid = cv_view(strokes.solid);
  if (cv::countNonZero(solid) == 0) return lines;
  cv::Mat outline;
  const auto cross = cv::getStructuringElement(cv::MORPH_CROSS, {3, 3});
  cv::erode(solid, outline, cross);
  cv::subtract(solid, outline, outline);
  picture.setTo(cv::Scalar(kSolidFace), outline);
  return lines;
}

}  // namespace madori::mapping
