#include "mapping/drawing/raster/detect_walls.hpp"

#include <algorithm>
#include <chrono>
#include <opencv2/imgproc.hpp>

#include "core/result.hpp"

namespace madori::mapping {

DetectedWalls detect_walls(const GrayImage& image, const DetectionOptions& options, const StageSink& sink,
                           const Progress& progress) {
  if (!options.is_valid()) throw Error("wall detection", options.why_invalid(), "correct the option");
  if (image.empty()) throw Error("wall detection", "the picture has no pixels", "import another drawing");
  const auto start = std::chrono::steady_clock::now();
  if (progress) progress("hough", 0);
  cv::Mat grey(image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat ink;
  cv::threshold(grey, ink, options.threshold.value_or(128), 255,
                cv::THRESH_BINARY_INV | (options.threshold ? 0 : cv::THRESH_OTSU));
  if (sink)
    sink("binarize", {image.width_px, image.height_px,
                      std::vector<std::uint8_t>(ink.data, ink.data + ink.total()), image.dpi});
  const double shortest =
      options.min_wall_length_px.value_or(std::max(image.width_px, image.height_px) * 0.015);
  std::vector<cv::Vec4i> lines;
  cv::HoughLinesP(ink, lines, 1, CV_PI / 180, 50, shortest, options.close_gap_px.value_or(3));
  DetectedWalls found;
  for (const auto& line : lines)
    found.walls.push_back({line[0] + 0.5, line[1] + 0.5, line[2] + 0.5, line[3] + 0.5});
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  found.stages.push_back({"hough", spent.count(), found.walls.size()});
  return found;
}

}  // namespace madori::mapping
