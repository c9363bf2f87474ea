#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/cycle/site_config.hpp"
#include "app/demo/demo_run.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

constexpr double kPixelsPerMetre = 16.0;
constexpr int kMargin_px = 30;
const cv::Scalar kWall(60, 60, 60), kRoute(225, 200, 160), kDriven(40, 40, 200), kStation(150, 90, 20);

/// Map metres to pixels of a picture that shows all walls.
class Canvas {
 public:
  explicit Canvas(const mapping::Walls& walls) {
    double x1 = -1e9;
    double y1 = -1e9;
    for (const auto& wall : walls)
      for (const auto& p : {wall.segment.a, wall.segment.b}) {
        x0_ = std::min(x0_, p.x_m);
        y0_ = std::min(y0_, p.y_m);
        x1 = std::max(x1, p.x_m);
        y1 = std::max(y1, p.y_m);
      }
    height_ = static_cast<int>((y1 - y0_) * kPixelsPerMetre) + 2 * kMargin_px;
    picture_ = cv::Mat(height_, static_cast<int>((x1 - x0_) * kPixelsPerMetre) + 2 * kMargin_px, CV_8UC3,
                       cv::Scalar(255, 255, 255));
  }
  [[nodiscard]] cv::Point at(const Point2<Map>& p) const {
    return {static_cast<int>((p.x_m - x0_) * kPixelsPerMetre) + kMargin_px,
            height_ - kMargin_px - static_cast<int>((p.y_m - y0_) * kPixelsPerMetre)};
  }
  void line(const Segment2<Map>& s, const cv::Scalar& color, int width) {
    cv::line(picture_, at(s.a), at(s.b), color, width, cv::LINE_AA);
  }
  void text(const Point2<Map>& p, const std::string& text, const cv::Scalar& color) {
    cv::circle(picture_, at(p), 6, color, cv::FILLED, cv::LINE_AA);
    cv::putText(picture_, text, at(p) + cv::Point(9, -7), cv::FONT_HERSHEY_SIMPLEX, 0.55, color, 1,
                cv::LINE_AA);
  }
  [[nodiscard]] const cv::Mat& picture() const { return picture_; }

 private:
  double x0_ = 1e9, y0_ = 1e9;
  int height_ = 0;
  cv::Mat picture_;
};

}  // namespace

void draw_demo(const std::filesystem::path& site, const DemoResult& result,
               const std::filesystem::path& png) {
  const auto loaded = load_for_driving(site);
  Canvas canvas(loaded.walls);
  const auto& nodes = loaded.config.routes.nodes();
  for (const auto& leg : loaded.config.routes.legs())
    canvas.line({nodes[leg.from].position, nodes[leg.to].position}, kRoute, 3);
  for (const auto& wall : loaded.walls) canvas.line(wall.segment, kWall, 1);
  for (std::size_t i = 1; i < result.driven.size(); ++i)
    canvas.line({result.driven[i - 1], result.driven[i]}, kDriven, 2);
  int number = 0;
  if (!result.driven.empty()) canvas.text(result.driven.front(), "start", kStation);
  for (const auto& delivery : result.deliveries) {
    const auto node = loaded.config.routes.index_of(delivery.node);
    ++number;
    if (node) canvas.text(nodes[*node].position, std::to_string(number) + " " + delivery.name, kStation);
  }
  if (!cv::imwrite(png.string(), canvas.picture()))
    throw Error(png.string(), "cannot be written", "check the folder and its permissions");
}

}  // namespace madori::app
