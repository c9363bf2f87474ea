#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// Colours that the colour-blind tell apart too (Okabe and Ito, Color Universal Design, 2008).
namespace colours {
inline constexpr Colour kPaper{255, 255, 255}, kInk{40, 40, 40}, kGrey{150, 150, 150}, kPale{215, 215, 215};
inline constexpr Colour kBlue{0, 114, 178}, kSky{86, 180, 233}, kGreen{0, 158, 115};
inline constexpr Colour kOrange{230, 159, 0}, kVermillion{213, 94, 0}, kPurple{204, 121, 167};
}  // namespace colours

/// How an entry of the legend is drawn.
enum class Mark { Line, Dashed, Crossed, Dot, Square, Ellipse };

struct LegendEntry {
  Mark mark = Mark::Line;
  Colour colour;
  int width_px = 2;
  std::string text;
};

/// A picture of a piece of the Map, to scale, y up, with a title, a scale bar and a legend below it. Widths
/// and radii are in pixels of the picture, everything else in metres of the Map.
class MapCanvas {
 public:
  /// Shows all walls and the other points, with a margin; the longer side of the map has `longest_px`.
  MapCanvas(const mapping::Walls& walls, const std::vector<Point2<Map>>& others, int longest_px = 1400);
  ~MapCanvas();
  MapCanvas(const MapCanvas&) = delete;
  MapCanvas& operator=(const MapCanvas&) = delete;

  [[nodiscard]] double px_per_m() const;
  void line(const Segment2<Map>& s, const Colour& colour, int width_px = 1);
  void dashed(const Segment2<Map>& s, const Colour& colour, int width_px = 1);
  /// A small x.
  void cross(const Point2<Map>& p, const Colour& colour, int radius_px = 4);
  void dot(const Point2<Map>& p, const Colour& colour, int radius_px = 3);
  void square(const Point2<Map>& centre, double side_m, const Colour& colour);
  /// `sigmas` standard deviations of a position; an axis is drawn at most `longest_m` long.
  void ellipse(const Point2<Map>& centre, const Eigen::Matrix2d& covariance, double sigmas, double longest_m,
               const Colour& colour, int width_px = 1);
  void text(const Point2<Map>& p, const std::string& text, const Colour& colour);
  void walls(const mapping::Walls& walls, const Colour& colour, int width_px = 1);
  void title(const std::string& text);
  /// A band of colours from left to right below the map, with what it means.
  void strip(const std::vector<Colour>& parts, const std::string& caption);
  void legend(const std::vector<LegendEntry>& entries);
  /// PNG bytes.
  [[nodiscard]] std::vector<std::uint8_t> png() const;

 private:
  struct Picture;
  std::unique_ptr<Picture> picture_;
};

}  // namespace madori::app
