#include "localization/warp/wall_sides.hpp"

#include <algorithm>
#include <cmath>

#include "core/segment_distance.hpp"
#include "localization/drawing_fit/visible_faces.hpp"
#include "localization/drawing_fit/wall_hits.hpp"

namespace madori::localization {
namespace {

constexpr double kLeastCos = 0.85;     ///< of the angle between surface and wall: 32 degrees
constexpr double kDirectionRad = 0.2;  ///< standard deviation of a seen surface's direction
constexpr double kHiddenOdds = 0.05;   ///< that a face is seen through the other face of its wall

}  // namespace

WallSides::WallSides(const mapping::Walls& walls) {
  low_ = {1e9, 1e9};
  high_ = {-1e9, -1e9};
  lines_.reserve(walls.size());
  for (const mapping::Wall& wall : walls) {
    const Segment2<Map>& s = wall.segment;
    Line line;
    line.a = s.a;
    line.length_m = s.length_m();
    if (line.length_m > 0.0) {
      line.ux = (s.b.x_m - s.a.x_m) / line.length_m;
      line.uy = (s.b.y_m - s.a.y_m) / line.length_m;
    }
    lines_.push_back(line);
    low_ = {std::min({low_.x_m, s.a.x_m, s.b.x_m}), std::min({low_.y_m, s.a.y_m, s.b.y_m})};
    high_ = {std::max({high_.x_m, s.a.x_m, s.b.x_m}), std::max({high_.y_m, s.a.y_m, s.b.y_m})};
  }
  if (walls.empty()) low_ = high_ = {0.0, 0.0};
  hash();
  find_faces(walls);
}

std::size_t WallSides::cell_of(const Point2<Map>& p) const {
  const double u = (p.x_m - low_.x_m + kReachM) / kCellM;
  const double v = (p.y_m - low_.y_m + kReachM) / kCellM;
  if (!(u >= 0.0 && v >= 0.0 && u < columns_ && v < rows_)) return kNoCell;
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(u);
}

void WallSides::hash() {
  columns_ = static_cast<int>((high_.x_m - low_.x_m + 2.0 * kReachM) / kCellM) + 1;
  rows_ = static_cast<int>((high_.y_m - low_.y_m + 2.0 * kReachM) / kCellM) + 1;
  const std::size_t cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  const double reach = kReachM + kBeyondM + 0.71 * kCellM;
  std::vector<std::vector<std::uint32_t>> near(cells);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const Segment2<Map> s{line.a, foot(i, line.length_m)};
    const auto cell = [](double value, double from, int count) {
      return std::clamp(static_cast<int>((value - from + kReachM) / kCellM), 0, count - 1);
    };
    const auto [left, right] = std::minmax(s.a.x_m, s.b.x_m);
    const auto [bottom, top] = std::minmax(s.a.y_m, s.b.y_m);
    for (int y = cell(bottom - reach, low_.y_m, rows_); y <= cell(top + reach, low_.y_m, rows_); ++y) {
      for (int x = cell(left - reach, low_.x_m, columns_); x <= cell(right + reach, low_.x_m, columns_);
           ++x) {
        const Point2<Map> centre{low_.x_m - kReachM + (x + 0.5) * kCellM,
                                 low_.y_m - kReachM + (y + 0.5) * kCellM};
        if (distance_m(s, centre) <= reach)
          near[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)]
              .push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  first_.assign(cells + 1, 0);
  for (std::size_t c = 0; c < cells; ++c) {
    walls_.insert(walls_.end(), near[c].begin(), near[c].end());
    first_[c + 1] = static_cast<std::uint32_t>(walls_.size());
  }
}

void WallSides::find_faces(const mapping::Walls& walls) {
  const std::vector<VisibleFace> faces = visible_faces(walls);
  for (std::size_t i = 0; i < lines_.size(); ++i)
    for (std::size_t side = 0; side < 2; ++side) {
      double seen_m = 0.0;
      for (const SeenStretch& s : faces[i][side]) seen_m += s.to_m - s.from_m;
      const double share = lines_[i].length_m > 0.0 ? seen_m / lines_[i].length_m : 1.0;
      lines_[i].open[side] = kHiddenOdds + (1.0 - kHiddenOdds) * share;
    }
}

bool WallSides::belongs(const Point2<Map>& p, double nx, double ny, Candidate& found) const {
  const Line& line = lines_[found.wall];
  const double px = p.x_m - line.a.x_m;
  const double py = p.y_m - line.a.y_m;
  found.distance_m = -line.uy * px + line.ux * py;
  if (std::abs(found.distance_m) > kReachM) return false;
  const double along = line.ux * px + line.uy * py;
  if (along < -kBeyondM || along > line.length_m + kBeyondM) return false;
  const double facing = -line.uy * nx + line.ux * ny;
  if (std::abs(facing) < kLeastCos) return false;
  found.side = facing > 0.0 ? 0 : 1;
  found.along_m = std::clamp(along, 0.0, line.length_m);
  const double square = 2.0 * (1.0 - std::abs(facing));  // of the angle, nearly
  found.odds = line.open[found.side] * std::exp(-0.5 * square / (kDirectionRad * kDirectionRad));
  return true;
}

}  // namespace madori::localization
