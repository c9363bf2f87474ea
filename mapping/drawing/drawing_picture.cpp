#include "mapping/drawing/drawing_picture.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "mapping/drawing/plan.hpp"

namespace madori::mapping {

std::vector<std::uint8_t> drawing_picture(const std::filesystem::path& folder, const Site& site,
                                          int longest_px) {
  PlanOptions options;
  options.page = site.drawing.page;
  if (site.drawing.dpi > 0.0) options.dpi = site.drawing.dpi;
  Plan plan = load_plan(folder / site.drawing.file, options);
  const cv::Mat picture(plan.picture.height_px, plan.picture.width_px, CV_8UC1, plan.picture.pixels.data());
  const double zoom = std::min(1.0, static_cast<double>(longest_px) / std::max(picture.cols, picture.rows));
  cv::Mat small;
  cv::resize(picture, small, {}, zoom, zoom, cv::INTER_AREA);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", small, png, {cv::IMWRITE_PNG_COMPRESSION, 3});
  return png;
}

}  // namespace madori::mapping
