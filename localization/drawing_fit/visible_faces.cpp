#include "localization/drawing_fit/visible_faces.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <cstddef>
#include <utility>

namespace madori::localization {
namespace {

namespace bg = boost::geometry;
using Corner = bg::model::d2::point_xy<double>;
using Box = bg::model::box<Corner>;
using Boxes = bg::index::rtree<std::pair<Box, std::size_t>, bg::index::rstar<16>>;

constexpr double kThickestM = 0.45;  ///< of a wall drawn with two faces
constexpr double kThinnestM = 0.03;  ///< nearer lines are one face, drawn twice
constexpr double kParallel = 0.98;   ///< cosine between a wall's faces
constexpr double kStepM = 0.1;
constexpr double kShortestM =
    0.6;  ///< seen beside a hidden stretch: no wall joins it and no corner ends there

Box box_of(const Segment2<Map>& s, double margin_m) {
  const auto [left, right] = std::minmax(s.a.x_m, s.b.x_m);
  const auto [bottom, top] = std::minmax(s.a.y_m, s.b.y_m);
  return {{left - margin_m, bottom - margin_m}, {right + margin_m, top + margin_m}};
}

struct DrawnLine {
  explicit DrawnLine(const Segment2<Map>& s) : a(s.a), length_m(s.length_m()) {
    if (length_m > 0.0) ux = (s.b.x_m - s.a.x_m) / length_m, uy = (s.b.y_m - s.a.y_m) / length_m;
  }
  Point2<Map> a;
  double length_m;
  double ux = 1.0, uy = 0.0;

  [[nodiscard]] Point2<Map> at(double along_m) const { return {a.x_m + along_m * ux, a.y_m + along_m * uy}; }
  /// How far to the left of this line `other` lies, seen from `p` on this line; 0 where it does not.
  [[nodiscard]] double left_of(const Point2<Map>& p, const DrawnLine& other) const {
    if (std::abs(ux * other.ux + uy * other.uy) < kParallel) return 0.0;
    const double along = (p.x_m - other.a.x_m) * other.ux + (p.y_m - other.a.y_m) * other.uy;
    if (along < 0.0 || along > other.length_m) return 0.0;
    const Point2<Map> foot = other.at(along);
    return -uy * (foot.x_m - p.x_m) + ux * (foot.y_m - p.y_m);
  }
};

/// Of the samples that are not hidden, the runs that are long enough, or that nothing hidden ends.
std::vector<SeenStretch> runs(const std::vector<char>& hidden, double length_m) {
  const double step = length_m / static_cast<double>(hidden.size());
  std::vector<SeenStretch> seen;
  for (std::size_t i = 0, end = 0; i < hidden.size(); i = end) {
    while (end < hidden.size() && hidden[end] == hidden[i]) ++end;
    const SeenStretch run{static_cast<double>(i) * step, static_cast<double>(end) * step};
    const bool whole = i == 0 && end == hidden.size();
    if (hidden[i] == 0 && (whole || run.to_m - run.from_m >= kShortestM)) seen.push_back(run);
  }
  return seen;
}

VisibleFace face_of(const DrawnLine& line, const std::vector<const DrawnLine*>& others) {
  const auto samples = static_cast<std::size_t>(std::max(1.0, std::ceil(line.length_m / kStepM)));
  std::array<std::vector<char>, 2> hidden{std::vector<char>(samples), std::vector<char>(samples)};
  for (std::size_t k = 0; k < samples; ++k) {
    const Point2<Map> p =
        line.at((static_cast<double>(k) + 0.5) / static_cast<double>(samples) * line.length_m);
    bool by[2] = {false, false};
    for (const DrawnLine* other : others) {
      const double left = line.left_of(p, *other);
      if (std::abs(left) > kThinnestM && std::abs(left) < kThickestM) by[left > 0.0 ? 0 : 1] = true;
    }
    if (by[0] != by[1]) hidden[by[0] ? 0 : 1][k] = 1;
  }
  return {runs(hidden[0], line.length_m), runs(hidden[1], line.length_m)};
}

}  // namespace

std::vector<VisibleFace> visible_faces(const mapping::Walls& walls) {
  std::vector<DrawnLine> lines;
  std::vector<std::pair<Box, std::size_t>> boxes;
  for (const mapping::Wall& wall : walls) {
    if (wall.probability >= 0.5) boxes.emplace_back(box_of(wall.segment, 0.0), lines.size());
    lines.emplace_back(wall.segment);
  }
  const Boxes tree(boxes.begin(), boxes.end());
  std::vector<VisibleFace> faces;
  std::vector<const DrawnLine*> others;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    others.clear();
    const Box near = box_of(walls[i].segment, kThickestM);
    for (auto found = tree.qbegin(bg::index::intersects(near)); found != tree.qend(); ++found)
      if (found->second != i) others.push_back(&lines[found->second]);
    faces.push_back(face_of(lines[i], others));
  }
  return faces;
}

}  // namespace madori::localization
