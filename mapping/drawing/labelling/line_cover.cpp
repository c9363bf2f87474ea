#include "mapping/drawing/labelling/line_cover.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace madori::mapping {
namespace {

constexpr double kSlack = 1.25;        // pixels of the lines' picture between a line and its edges
constexpr double kMiss = 0.5;          // by which edges usually miss their line
constexpr double kCoarsest = 2;        // pixels of the sheet for one of the lines: no edge is told finer
constexpr double kParallelSine = 0.2;  // of short edges the direction is vague
constexpr int kPlaces = 12;            // of an edge that are looked at, at most

}  // namespace

LineCover::LineCover(const DrawnLines& lines, const EdgeSheet& sheet, double u_scale, double v_scale)
    : lines_(lines), sheet_(sheet), u_scale_(u_scale), v_scale_(v_scale) {}

double LineCover::pixel_px() const {
  return std::max({kCoarsest, u_scale_, v_scale_});
}

double LineCover::reach_px(const DrawnLine& line) const {
  return kSlack * pixel_px() + (line.solid_face ? 0 : 0.5 * line.stroke_px * std::max(u_scale_, v_scale_));
}

double LineCover::at(std::size_t number, double t, const std::vector<float>& values) const {
  const DrawnLine& line = lines_[number];
  const PixelSegment s = on_sheet(line.segment);
  const double length = std::max(1e-9, s.length_px());
  const double nu = -(s.v2 - s.v1) / length, nv = (s.u2 - s.u1) / length;
  const double u = std::lerp(s.u1, s.u2, t), v = std::lerp(s.v1, s.v2, t), reach = reach_px(line);
  const double expected =
      reach - kSlack * pixel_px();  // the edges of a stroke lie on both sides of its middle
  double sum = 0, weights = 0;
  int last = -1;
  for (double d = -reach; d <= reach; d += 0.7) {
    if (!sheet_.inside(u + d * nu, v + d * nv)) continue;
    const int edge = sheet_.edge_at[sheet_.pixel(u + d * nu, v + d * nv)];
    if (edge < 0 || edge == last) continue;
    last = edge;
    const Edge& e = sheet_.edges[static_cast<std::size_t>(edge)];
    if (std::abs(e.normal_u * nv - e.normal_v * nu) > kParallelSine) continue;
    const double miss = (std::abs(d) - expected) / (kMiss * pixel_px());
    const double weight = std::exp(-0.5 * miss * miss);
    sum += weight * values[static_cast<std::size_t>(edge)];
    weights += weight;
  }
  return weights > 0 ? sum / weights : -1;
}

std::vector<float> LineCover::covered(const std::vector<bool>& chosen) const {
  cv::Mat numbers(sheet_.grey.height_px, sheet_.grey.width_px, CV_32SC1, cv::Scalar(-1));
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!chosen[i]) continue;
    const PixelSegment s = on_sheet(lines_[i].segment);
    const auto at = [](double u, double v) {
      return cv::Point(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
    };
    cv::line(numbers, at(s.u1, s.v1), at(s.u2, s.v2), cv::Scalar(static_cast<double>(i)),
             static_cast<int>(std::lround(2 * reach_px(lines_[i]))));
  }
  std::vector<float> share(sheet_.edges.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    const Edge& e = sheet_.edges[i];
    const int places = std::clamp(static_cast<int>(e.length_px / 3), 3, kPlaces);
    int on = 0;
    for (int k = 0; k < places; ++k) {
      const double t = (k + 0.5) / places;
      const double u = std::lerp(e.segment.u1, e.segment.u2, t), v = std::lerp(e.segment.v1, e.segment.v2, t);
      if (!sheet_.inside(u, v)) continue;
      const int number = numbers.at<int>(static_cast<int>(v), static_cast<int>(u));
      if (number < 0) continue;
      const PixelSegment s = on_sheet(lines_[static_cast<std::size_t>(number)].segment);
      const double along = e.normal_u * (s.u2 - s.u1) + e.normal_v * (s.v2 - s.v1);
      on += std::abs(along) < kParallelSine * s.length_px() ? 1 : 0;
    }
    share[i] = static_cast<float>(on) / static_cast<float>(places);
  }
  return share;
}

}  // namespace madori::mapping
