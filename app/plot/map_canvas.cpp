#include "app/plot/map_canvas.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/angle.hpp"

namespace madori::app {
namespace {

constexpr int kMargin_px = 24;
constexpr int kTitle_px = 44;
constexpr int kRow_px = 26;
constexpr int kShift = 4;  // OpenCV draws at 1/16 pixel
constexpr double kFont = 0.5;

cv::Scalar bgr(const Colour& c) {
  return {static_cast<double>(c.blue), static_cast<double>(c.green), static_cast<double>(c.red)};
}

struct Box {
  double x1 = 1e300, y1 = 1e300, x2 = -1e300, y2 = -1e300;
  void add(const Point2<Map>& p) {
    x1 = std::min(x1, p.x_m), x2 = std::max(x2, p.x_m);
    y1 = std::min(y1, p.y_m), y2 = std::max(y2, p.y_m);
  }
};

}  // namespace

struct MapCanvas::Picture {
  cv::Mat pixels;
  Box box;
  double px_per_m = 1.0;
  int map_height = 1;

  [[nodiscard]] cv::Point2d at(const Point2<Map>& p) const {
    return {kMargin_px + (p.x_m - box.x1) * px_per_m,
            kTitle_px + kMargin_px + map_height - (p.y_m - box.y1) * px_per_m};
  }
  [[nodiscard]] static cv::Point fine(const cv::Point2d& p) {
    return {cvRound(p.x * (1 << kShift)), cvRound(p.y * (1 << kShift))};
  }
  void stroke(const cv::Point2d& a, const cv::Point2d& b, const Colour& colour, int width_px) {
    cv::line(pixels, fine(a), fine(b), bgr(colour), width_px, cv::LINE_AA, kShift);
  }
  void dashes(const cv::Point2d& a, const cv::Point2d& b, const Colour& colour, int width_px) {
    constexpr double kDash_px = 5.0;
    const cv::Point2d d = b - a;
    const double length = std::max(1e-9, std::hypot(d.x, d.y));
    for (double t = 0.0; t < length; t += 2.0 * kDash_px)
      stroke(a + d * (t / length), a + d * (std::min(length, t + kDash_px) / length), colour, width_px);
  }
  void cross(const cv::Point2d& p, const Colour& colour, int radius_px) {
    const double r = radius_px;
    stroke({p.x - r, p.y - r}, {p.x + r, p.y + r}, colour, 2);
    stroke({p.x - r, p.y + r}, {p.x + r, p.y - r}, colour, 2);
  }
  void write(const std::string& text, const cv::Point2d& p, double size) {
    cv::putText(pixels, text, p, cv::FONT_HERSHEY_SIMPLEX, size, bgr(colours::kInk), 1, cv::LINE_AA);
  }
  void mark(const LegendEntry& entry, const cv::Point2d& p) {
    const cv::Point2d end = p + cv::Point2d(34.0, 0.0);
    const cv::Point2d middle = p + cv::Point2d(17.0, 0.0);
    switch (entry.mark) {
      case Mark::Line:
        return stroke(p, end, entry.colour, entry.width_px);
      case Mark::Dashed:
        return dashes(p, end, entry.colour, entry.width_px);
      case Mark::Crossed:
        dashes(p, end, entry.colour, entry.width_px);
        return cross(middle, entry.colour, 4);
      case Mark::Dot:
        return cv::circle(pixels, fine(middle), entry.width_px << kShift, bgr(entry.colour), cv::FILLED,
                          cv::LINE_AA, kShift);
      case Mark::Square:
        return cv::rectangle(pixels, cv::Rect(cvRound(middle.x) - 8, cvRound(middle.y) - 8, 16, 16),
                             bgr(entry.colour), cv::FILLED);
      case Mark::Ellipse:
        return cv::ellipse(pixels, middle, cv::Size(15, 6), 0.0, 0.0, 360.0, bgr(entry.colour),
                           entry.width_px, cv::LINE_AA);
    }
  }
  /// A bar of 1, 2, 5, 10 ... metres at the lower right of the map.
  void scale_bar() {
    double metres = 1.0;
    for (const double m : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
      if (m * px_per_m < 180.0) metres = m;
    const cv::Point2d end(pixels.cols - kMargin_px, kTitle_px - 12.0);
    const cv::Point2d begin = end - cv::Point2d(metres * px_per_m, 0.0);
    stroke(begin, end, colours::kInk, 3);
    const std::string text = std::to_string(static_cast<int>(metres)) + " m";
    write(text, begin - cv::Point2d(12.0 + 9.0 * static_cast<double>(text.size()), -4.0), kFont);
  }
};

MapCanvas::MapCanvas(const mapping::Walls& walls, const std::vector<Point2<Map>>& others, int longest_px)
    : picture_(std::make_unique<Picture>()) {
  Box& box = picture_->box;
  for (const mapping::Wall& wall : walls) box.add(wall.segment.a), box.add(wall.segment.b);
  for (const Point2<Map>& p : others) box.add(p);
  if (box.x1 > box.x2) box = {0.0, 0.0, 1.0, 1.0};
  const double wide = std::max(1e-3, box.x2 - box.x1);
  const double tall = std::max(1e-3, box.y2 - box.y1);
  picture_->px_per_m = longest_px / std::max(wide, tall);
  picture_->map_height = std::max(1, static_cast<int>(tall * picture_->px_per_m));
  const int columns = std::max(640, static_cast<int>(wide * picture_->px_per_m) + 2 * kMargin_px);
  picture_->pixels =
      cv::Mat(picture_->map_height + 2 * kMargin_px + kTitle_px, columns, CV_8UC3, bgr(colours::kPaper));
  picture_->scale_bar();
}

MapCanvas::~MapCanvas() = default;

double MapCanvas::px_per_m() const {
  return picture_->px_per_m;
}

void MapCanvas::line(const Segment2<Map>& s, const Colour& colour, int width_px) {
  picture_->stroke(picture_->at(s.a), picture_->at(s.b), colour, width_px);
}

void MapCanvas::dashed(const Segment2<Map>& s, const Colour& colour, int width_px) {
  picture_->dashes(picture_->at(s.a), picture_->at(s.b), colour, width_px);
}

void MapCanvas::cross(const Point2<Map>& p, const Colour& colour, int radius_px) {
  picture_->cross(picture_->at(p), colour, radius_px);
}

void MapCanvas::dot(const Point2<Map>& p, const Colour& colour, int radius_px) {
  cv::circle(picture_->pixels, Picture::fine(picture_->at(p)), radius_px << kShift, bgr(colour), cv::FILLED,
             cv::LINE_AA, kShift);
}

void MapCanvas::square(const Point2<Map>& centre, double side_m, const Colour& colour) {
  const cv::Point2d low = picture_->at({centre.x_m - 0.5 * side_m, centre.y_m - 0.5 * side_m});
  const cv::Point2d high = picture_->at({centre.x_m + 0.5 * side_m, centre.y_m + 0.5 * side_m});
  cv::rectangle(picture_->pixels, cv::Point(cvFloor(low.x), cvFloor(high.y)),
                cv::Point(cvFloor(high.x), cvFloor(low.y)), bgr(colour), cv::FILLED);
}

void MapCanvas::ellipse(const Point2<Map>& centre, const Eigen::Matrix2d& covariance, double sigmas,
                        double longest_m, const Colour& colour, int width_px) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const auto half = [&](int i) {
    const double m = sigmas * std::sqrt(std::max(0.0, axes.eigenvalues()[i]));
    return std::max(1.0, std::min(m, longest_m) * picture_->px_per_m);
  };
  const double turn = std::atan2(axes.eigenvectors()(1, 1), axes.eigenvectors()(0, 1));
  const cv::Size size(cvRound(half(1) * (1 << kShift)), cvRound(half(0) * (1 << kShift)));
  cv::ellipse(picture_->pixels, Picture::fine(picture_->at(centre)), size, -to_deg(turn), 0.0, 360.0,
              bgr(colour), width_px, cv::LINE_AA, kShift);
}

void MapCanvas::text(const Point2<Map>& p, const std::string& text, const Colour& colour) {
  cv::putText(picture_->pixels, text, picture_->at(p), cv::FONT_HERSHEY_SIMPLEX, kFont, bgr(colour), 1,
              cv::LINE_AA);
}

void MapCanvas::walls(const mapping::Walls& walls, const Colour& colour, int width_px) {
  for (const mapping::Wall& wall : walls) line(wall.segment, colour, width_px);
}

void MapCanvas::title(const std::string& text) {
  picture_->write(text, {kMargin_px * 1.0, kTitle_px - 14.0}, 0.62);
}

void MapCanvas::legend(const std::vector<LegendEntry>& entries) {
  Picture& p = *picture_;
  const int top = p.pixels.rows;
  const int rows = static_cast<int>(entries.size());
  const cv::Mat room(rows * kRow_px + 10, p.pixels.cols, CV_8UC3, bgr(colours::kPaper));
  cv::vconcat(p.pixels, room, p.pixels);
  for (int i = 0; i < rows; ++i) {
    const cv::Point2d at(kMargin_px, top + i * kRow_px + 8.0);
    const LegendEntry& entry = entries[static_cast<std::size_t>(i)];
    p.mark(entry, at);
    p.write(entry.text, at + cv::Point2d(46.0, 5.0), kFont);
  }
}

void MapCanvas::strip(const std::vector<Colour>& parts, const std::string& caption) {
  constexpr int kCaption_px = 160;
  Picture& p = *picture_;
  const int top = p.pixels.rows;
  cv::vconcat(p.pixels, cv::Mat(kRow_px + 8, p.pixels.cols, CV_8UC3, bgr(colours::kPaper)), p.pixels);
  const double left = kMargin_px + kCaption_px;
  const double wide = (p.pixels.cols - kMargin_px - left) / static_cast<double>(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int from = cvRound(left + wide * static_cast<double>(i));
    const int to = cvRound(left + wide * static_cast<double>(i + 1));
    cv::rectangle(p.pixels, cv::Rect(from, top + 2, std::max(1, to - from), kRow_px - 8), bgr(parts[i]),
                  cv::FILLED);
  }
  p.write(caption, {kMargin_px * 1.0, top + 17.0}, kFont);
}

std::vector<std::uint8_t> MapCanvas::png() const {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture_->pixels, bytes);
  return bytes;
}

}  // namespace madori::app
