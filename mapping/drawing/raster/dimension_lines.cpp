#include "mapping/drawing/raster/dimension_lines.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kAlongText = 0.2;  // radians
constexpr double kSlanted = 0.4;    // radians, at least, between a tick and its line
constexpr double kUpright = 1.2;    // radians, at least, between an extension line and the dimension line
constexpr double kTextReach = 1.5;  // text heights between number and line
constexpr double kTickInPens = 18;

class DimensionFinder {
 public:
  DimensionFinder(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style,
                  double pen_px)
      : lines_(lines), evidence_(evidence), style_(style), pen_(pen_px), index_(lines, 64) {}

  void along(const TextGroup& text) {
    const double reach = 0.5 * text.length_px + kTextReach * text.height_px;
    index_.near(text.middle_u, text.middle_v, reach, [&](std::size_t i) {
      if (!is_thin_single(i) || angle_between(lines_[i].angle_rad(), text.angle_rad) > kAlongText) return;
      const FittedLine line = line_through(lines_[i].segment);
      const double half = 0.5 * lines_[i].length_px(),
                   at = std::abs(line.along(text.middle_u, text.middle_v));
      if (std::abs(line.across(text.middle_u, text.middle_v)) > kTextReach * text.height_px) return;
      const bool under = at < 0.85 * half && 2 * half > text.length_px;
      const bool beside = at > half && at - half < text.length_px &&
                          std::abs(line.across(text.middle_u, text.middle_v)) < 0.5 * text.height_px;
      const bool centred = at < 0.3 * half && 2 * half > 2 * text.length_px;
      if (under && centred) certain_.push_back(i);
      if (under || beside) candidates_.push_back(i);
    });
  }

  void ticked() {
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (is_thin_single(i) && lines_[i].length_px() > kTickInPens * pen_) candidates_.push_back(i);
  }

  void reject() {
    std::vector<std::size_t> found = certain_;
    for (const std::size_t i : candidates_) {
      const PixelSegment& s = lines_[i].segment;
      if (!lines_[i].rejected && has_tick(i, s.u1, s.v1) && has_tick(i, s.u2, s.v2)) found.push_back(i);
    }
    for (const std::size_t i : found) lines_[i].rejected = RejectReason::Dimension;
    for (const std::size_t i : found) {
      const PixelSegment& s = lines_[i].segment;
      reject_at_end(i, s.u1, s.v1);
      reject_at_end(i, s.u2, s.v2);
    }
  }

 private:
  [[nodiscard]] bool is_thin_single(std::size_t i) const {
    return !lines_[i].solid_face && lines_[i].stroke_px < style_.bold_px &&
           evidence_[i].paired_px < 0.3 * lines_[i].length_px();
  }
  [[nodiscard]] double tick_reach() const { return 0.5 * kTickInPens * pen_; }

  /// A short slanted line, arrow or star at this end of a line.
  [[nodiscard]] bool has_tick(std::size_t self, double u, double v) const {
    bool met = false;
    index_.near(u, v, tick_reach(), [&](std::size_t j) {
      if (met || j == self || lines_[j].length_px() > 2 * kTickInPens * pen_) return;
      const double turn = angle_between(lines_[self].angle_rad(), lines_[j].angle_rad());
      const PixelSegment& s = lines_[j].segment;
      const double off = std::hypot(0.5 * (s.u1 + s.u2) - u, 0.5 * (s.v1 + s.v2) - v);
      met = turn > kSlanted && turn < kUpright && off < 0.5 * s.length_px() + 2 * pen_ && off < tick_reach();
    });
    return met;
  }

  void reject_at_end(std::size_t self, double u, double v) {
    const double reach = tick_reach();
    index_.near(u, v, reach, [&](std::size_t j) {
      if (j == self || lines_[j].rejected || !is_thin_single(j)) return;
      const FittedLine line = line_through(lines_[j].segment);
      const double half = 0.5 * lines_[j].length_px(), at = std::abs(line.along(u, v));
      const bool is_short = 2 * half < kTickInPens * pen_ && at < reach + half;
      const bool ends_here = at > half - reach && at < half + 2 * pen_;
      const bool upright = angle_between(lines_[self].angle_rad(), lines_[j].angle_rad()) > kUpright;
      if (std::abs(line.across(u, v)) < 2 * pen_ + (is_short ? reach : 0) &&
          (is_short || (ends_here && upright)))
        lines_[j].rejected = RejectReason::Dimension;
    });
  }

  DrawnLines& lines_;
  const std::vector<Evidence>& evidence_;
  const WallStyle& style_;
  double pen_;
  LineIndex index_;
  std::vector<std::size_t> certain_, candidates_;
};

}  // namespace

void reject_dimensions(DrawnLines& lines, const std::vector<TextGroup>& texts,
                       const std::vector<Evidence>& evidence, const WallStyle& style, double pen_px) {
  DimensionFinder finder(lines, evidence, style, pen_px);
  for (const TextGroup& text : texts) finder.along(text);
  finder.ticked();
  finder.reject();
}

}  // namespace madori::mapping
