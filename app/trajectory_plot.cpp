#include "app/trajectory_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/drawing/palette_png.hpp"

namespace madori::app {
namespace {

constexpr std::array<mapping::PaletteColour, 7> kColours{{{255, 255, 255},  // paper
                                                          {150, 150, 150},  // walls
                                                          {20, 150, 40},    // the four states in their order
                                                          {235, 180, 0},
                                                          {30, 80, 230},
                                                          {220, 30, 30},
                                                          {120, 120, 120}}};  // ticks
constexpr std::uint8_t kWall = 1;
constexpr std::uint8_t kFirstState = 2;
constexpr std::uint8_t kTick = 6;
constexpr double kMarginM = 1.0;
constexpr double kJumpM = 2.0;  // a pose this far from its forerunner was found anew: no line between them

/// A sheet of palette indices over a piece of the Map.
class Sheet {
 public:
  Sheet(const mapping::Walls& walls, const std::vector<PoseEstimate>& estimates, int widest_px) {
    for (const mapping::Wall& wall : walls) {
      include(wall.segment.a);
      include(wall.segment.b);
    }
    for (const PoseEstimate& e : estimates) include(e.map_from_base.translation());
    const double wide = high_.x_m - low_.x_m + 2.0 * kMarginM;
    const double tall = high_.y_m - low_.y_m + 2.0 * kMarginM;
    px_per_m_ = widest_px / std::max(wide, tall);
    width_ = std::max(1, static_cast<int>(wide * px_per_m_));
    height_ = std::max(1, static_cast<int>(tall * px_per_m_));
    pixels_.assign(static_cast<std::size_t>(width_) * height_, 0);
  }

  void line(const Point2<Map>& a, const Point2<Map>& b, std::uint8_t colour, int thick) {
    const int steps = static_cast<int>(std::ceil(distance_m(a, b) * px_per_m_)) + 1;
    for (int i = 0; i <= steps; ++i) {
      const double f = static_cast<double>(i) / steps;
      dot({a.x_m + f * (b.x_m - a.x_m), a.y_m + f * (b.y_m - a.y_m)}, colour, thick);
    }
  }
  [[nodiscard]] std::vector<std::uint8_t> png() const {
    return mapping::palette_png(width_, height_, pixels_, kColours);
  }

 private:
  void include(const Point2<Map>& p) {
    if (!started_) low_ = high_ = p;
    started_ = true;
    low_ = {std::min(low_.x_m, p.x_m), std::min(low_.y_m, p.y_m)};
    high_ = {std::max(high_.x_m, p.x_m), std::max(high_.y_m, p.y_m)};
  }
  void dot(const Point2<Map>& p, std::uint8_t colour, int thick) {
    const int u = static_cast<int>((p.x_m - low_.x_m + kMarginM) * px_per_m_);
    const int v = height_ - 1 - static_cast<int>((p.y_m - low_.y_m + kMarginM) * px_per_m_);
    for (int y = v; y < v + thick; ++y)
      for (int x = u; x < u + thick; ++x)
        if (x >= 0 && y >= 0 && x < width_ && y < height_)
          pixels_[static_cast<std::size_t>(y) * width_ + x] = colour;
  }

  bool started_ = false;
  Point2<Map> low_;
  Point2<Map> high_;
  double px_per_m_ = 1.0;
  int width_ = 1;
  int height_ = 1;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::vector<std::uint8_t> trajectory_plot(const mapping::Walls& walls,
                                          const std::vector<PoseEstimate>& estimates, int widest_px) {
  Sheet sheet(walls, estimates, widest_px);
  for (const mapping::Wall& wall : walls) sheet.line(wall.segment.a, wall.segment.b, kWall, 2);
  double since_tick_m = 0.0;
  for (std::size_t i = 1; i < estimates.size(); ++i) {
    const Transform2<Map, Base>& pose = estimates[i].map_from_base;
    const Point2<Map> before = estimates[i - 1].map_from_base.translation();
    const double moved_m = distance_m(before, pose.translation());
    if (moved_m > kJumpM) continue;
    since_tick_m += moved_m;
    if (since_tick_m > 1.0) {
      sheet.line(pose.translation(), pose * Point2<Base>{0.3, 0.0}, kTick, 1);
      since_tick_m = 0.0;
    }
    const auto state = static_cast<std::uint8_t>(estimates[i].health.state);
    sheet.line(before, pose.translation(), static_cast<std::uint8_t>(kFirstState + state), 2);
  }
  return sheet.png();
}

}  // namespace madori::app
