#include "tests/bench/wall_training/plan_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace madori::training {
namespace {

constexpr int kBits = 4;  // of a fine pixel

void shade(cv::Mat& picture, double depth, double fold, double noise, Chance& chance) {
  const double along = chance.between(0, 6.28), crease = chance.between(0.3, 0.7);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u) {
      const double x = static_cast<double>(u) / picture.cols, y = static_cast<double>(v) / picture.rows;
      double light = 1 - depth * (0.5 + 0.5 * std::sin(along + 2 * x + 1.5 * y));
      if (fold > 0) light *= 1 - 0.35 * std::exp(-std::abs(y - crease) * picture.rows / 3);
      const double grain = noise > 0 ? chance.between(-noise, noise) : 0;
      auto& pixel = picture.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] * light + grain);
    }
}

}  // namespace

PlanCanvas::PlanCanvas(cv::Size2d size_px, const PlanStyle& style)
    : style_(style),
      fine_(style.aliased            ? 1
            : size_px.area() > 2.5e6 ? 2
                                     : 3),
      sheet_(static_cast<int>(size_px.width), static_cast<int>(size_px.height)),
      picture_(static_cast<int>(sheet_.height * fine_), static_cast<int>(sheet_.width * fine_), CV_8UC3,
               style.ground),
      bodies_(picture_.size(), CV_8UC1, cv::Scalar(0)) {}

void PlanCanvas::stand_at(Point origin_px, double turn_rad) {
  origin_ = origin_px;
  cosine_ = std::cos(turn_rad);
  sine_ = std::sin(turn_rad);
}

Point PlanCanvas::on_sheet(Point m) const {
  const double u = m.x * style_.px_per_m, v = m.y * style_.px_per_m;
  return origin_ + Point(cosine_ * u - sine_ * v, sine_ * u + cosine_ * v);
}

cv::Point PlanCanvas::fine(Point metres) const {
  const Point p = on_sheet(metres) * fine_ * (1 << kBits);
  return {static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))};
}

int PlanCanvas::pen(double px) const {
  return std::max(1, static_cast<int>(std::lround(px * fine_)));
}

std::vector<Point> PlanCanvas::corners(const Box& b) {
  return {{b.x, b.y}, {b.x + b.width, b.y}, {b.x + b.width, b.y + b.height}, {b.x, b.y + b.height}};
}

void PlanCanvas::line(Point a, Point b, const cv::Scalar& colour, double pen_px) {
  cv::line(picture_, fine(a), fine(b), colour, pen(pen_px), cv::LINE_8, kBits);
}

void PlanCanvas::lines(const std::vector<Point>& points, bool closed, const cv::Scalar& colour,
                       double pen_px) {
  for (std::size_t k = 0; k + (closed ? 0 : 1) < points.size(); ++k)
    line(points[k], points[(k + 1) % points.size()], colour, pen_px);
}

void PlanCanvas::box(const Box& b, const cv::Scalar& colour, double pen_px) {
  lines(corners(b), true, colour, pen_px);
}

void PlanCanvas::fill(const std::vector<Point>& points, const cv::Scalar& colour) {
  std::vector<cv::Point> p;
  for (const Point& at : points) p.push_back(fine(at));
  cv::fillConvexPoly(picture_, p, colour, cv::LINE_8, kBits);
}

void PlanCanvas::arc(Point middle, cv::Size2d radius_m, double from_rad, double to_rad,
                     const cv::Scalar& colour, double pen_px) {
  std::vector<Point> points;
  const int steps = std::max(4, static_cast<int>(std::abs(to_rad - from_rad) * 8));
  for (int k = 0; k <= steps; ++k) {
    const double a = std::lerp(from_rad, to_rad, static_cast<double>(k) / steps);
    points.push_back(middle + Point(radius_m.width * std::cos(a), radius_m.height * std::sin(a)));
  }
  lines(points, false, colour, pen_px);
}

void PlanCanvas::dashed(Point a, Point b, const cv::Scalar& colour, double pen_px, double dash_px,
                        bool dotted) {
  const double length = cv::norm(b - a), dash = metres(dash_px);
  const auto piece = [&](double from, double to) {
    line(a + (b - a) * (from / length), a + (b - a) * (std::min(length, to) / length), colour, pen_px);
  };
  for (double at = 0; at < length; at += (dotted ? 2.2 : 1.7) * dash) {
    piece(at, at + dash);
    if (dotted && at + 1.6 * dash < length) piece(at + 1.5 * dash, at + 1.65 * dash);
  }
}

void PlanCanvas::text(Point at, const std::string& words, double height_px, const cv::Scalar& colour,
                      int face) {
  const cv::Point p = fine(at);
  const double size = height_px * fine_ / 22;
  cv::putText(picture_, words, {p.x >> kBits, p.y >> kBits}, face, size, colour,
              pen(style_.text_pen > 0 ? style_.text_pen : 0.09 * height_px), cv::LINE_AA);
}

void PlanCanvas::wall_body(const std::vector<Point>& points, bool cut) {
  std::vector<cv::Point> p;
  for (const Point& at : points) p.push_back(fine(at));
  cv::fillConvexPoly(bodies_, p, cv::Scalar(cut ? 0 : 255), cv::LINE_8, kBits);
}

void PlanCanvas::wall_line(Point a, Point b, const cv::Scalar& colour, double pen_px) {
  line(a, b, colour, pen_px);
  truth_line(a, b);
}

void PlanCanvas::draw_bodies(Chance& chance) {
  if (style_.body == Body::Hatched) {
    hatch_bodies(chance);
  } else if (style_.body != Body::Double && style_.body != Body::MixedDouble && style_.body != Body::Single) {
    picture_.setTo(style_.wall_fill, bodies_);
  }
  outline_bodies(style_.outline, style_.wall_pen,
                 style_.body == Body::Double || style_.body == Body::Hatched ||
                     style_.body == Body::FilledOutlined || style_.body == Body::MixedDouble);
}

void PlanCanvas::draw_bodies(const LightWalls& light) {
  bodies_.setTo(0, drawn_);
  picture_.setTo(light.body == Body::Double ? style_.ground : light.fill, bodies_);
  outline_bodies(light.outline, light.pen, light.body != Body::Filled);
}

void PlanCanvas::hatch_bodies(Chance& chance) {
  cv::Mat hatch(picture_.size(), CV_8UC3, style_.ground);
  const int step = std::max(2, pen(chance.between(3, 8))), lean = chance.one_in(0.3) ? 2 : 1;
  const bool crossed = chance.one_in(0.2);
  for (int k = -lean * hatch.rows; k < hatch.cols + lean * hatch.rows; k += step) {
    cv::line(hatch, {k, 0}, {k + lean * hatch.rows, hatch.rows}, style_.thing, pen(style_.thin_pen));
    if (crossed)
      cv::line(hatch, {k, 0}, {k - lean * hatch.rows, hatch.rows}, style_.thing, pen(style_.thin_pen));
  }
  hatch.copyTo(picture_, bodies_);
}

/// The outlines of the bodies are drawn, where the style draws them, and are what is true.
void PlanCanvas::outline_bodies(const cv::Scalar& colour, double pen_px, bool outlined) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(bodies_, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_SIMPLE);
  for (auto& outline : outlines) {
    std::vector<cv::Point> corners;
    cv::approxPolyDP(outline, corners, 0.8 * fine_, true);
    if (corners.size() < 2) continue;
    if (outlined) cv::polylines(picture_, corners, true, colour, pen(pen_px));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const cv::Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
      truth_.emplace_back(Point((a.x + 0.5) / fine_, (a.y + 0.5) / fine_),
                          Point((b.x + 0.5) / fine_, (b.y + 0.5) / fine_));
    }
  }
  drawn_ = bodies_.clone();
  bodies_.setTo(0);
}

cv::Mat PlanCanvas::copied(Chance& chance) const {
  cv::Mat out;
  cv::resize(picture_, out, sheet_, 0, 0, cv::INTER_AREA);
  if (style_.blur_px > 0) cv::GaussianBlur(out, out, {}, style_.blur_px);
  if (style_.shade > 0 || style_.noise > 0 || style_.fold > 0)
    shade(out, style_.shade, style_.fold, style_.noise, chance);
  if (style_.jpeg > 0) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", out, bytes, {cv::IMWRITE_JPEG_QUALITY, style_.jpeg});
    out = cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  return out;
}

}  // namespace madori::training
