#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/wall_training/plan_style.hpp"

namespace madori::training {

using Point = cv::Point2d;
using Box = cv::Rect2d;

/// A sheet of paper that is drawn on in metres of a building, wherever that stands on the sheet. Drawn finer
/// and reduced at the end, as a plotter's lines are.
class PlanCanvas {
 public:
  /// `size_px` of the sheet.
  PlanCanvas(cv::Size2d size_px, const PlanStyle& style);

  /// From now on: `origin_px` on the sheet is (0, 0), turned by `turn_rad`.
  void stand_at(Point origin_px, double turn_rad);
  [[nodiscard]] Point on_sheet(Point metres) const;  ///< pixels
  [[nodiscard]] double metres(double px) const { return px / style_.px_per_m; }

  void line(Point a, Point b, const cv::Scalar& colour, double pen_px);
  void lines(const std::vector<Point>& points, bool closed, const cv::Scalar& colour, double pen_px);
  void box(const Box& box, const cv::Scalar& colour, double pen_px);
  void fill(const std::vector<Point>& points, const cv::Scalar& colour);
  void fill(const Box& box, const cv::Scalar& colour) { fill(corners(box), colour); }
  void arc(Point middle, cv::Size2d radius_m, double from_rad, double to_rad, const cv::Scalar& colour,
           double pen_px);
  void dashed(Point a, Point b, const cv::Scalar& colour, double pen_px, double dash_px, bool dotted);
  void text(Point at, const std::string& words, double height_px, const cv::Scalar& colour, int face);

  /// Walls are gathered before they are drawn, so that they run into each other at corners.
  void wall_body(const std::vector<Point>& points, bool cut);
  void draw_bodies(Chance& chance);
  /// What was gathered since, in another way; where there are walls already they stay.
  void draw_bodies(const LightWalls& light);
  void wall_line(Point a, Point b, const cv::Scalar& colour, double pen_px);
  void truth_line(Point a, Point b) { truth_.emplace_back(on_sheet(a), on_sheet(b)); }

  [[nodiscard]] const std::vector<std::pair<Point, Point>>& truth() const { return truth_; }
  /// Reduced to the sheet's pixels, with what a scanner and a codec do to it.
  [[nodiscard]] cv::Mat copied(Chance& chance) const;
  [[nodiscard]] static std::vector<Point> corners(const Box& box);

 private:
  [[nodiscard]] cv::Point fine(Point metres) const;
  [[nodiscard]] int pen(double px) const;
  void hatch_bodies(Chance& chance);
  void outline_bodies(const cv::Scalar& colour, double pen_px, bool outlined);

  const PlanStyle& style_;
  double fine_ = 3;
  cv::Size sheet_;
  cv::Mat picture_, bodies_, drawn_;
  Point origin_;
  double cosine_ = 1, sine_ = 0;
  std::vector<std::pair<Point, Point>> truth_;
};

}  // namespace madori::training
