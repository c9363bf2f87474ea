#include "localization/placement/survey.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "localization/drawing_fit/wall_hits.hpp"
#include "localization/pose_axes.hpp"
#include "mapping/wall_map/grid_frame.hpp"

namespace madori::localization {
namespace {

constexpr double kStepRad = to_rad(4.0);
constexpr int kTurns = 90;
constexpr double kWork = 6e7;    // looks at the tables that one survey may take
constexpr double kOtherM = 0.9;  // a place this far, or turned by this much, is another place
constexpr double kOtherRad = to_rad(10.0);
constexpr std::size_t kBuffer = 4096;

struct Box {
  double x1 = 1e9, y1 = 1e9, x2 = -1e9, y2 = -1e9;
  void add(double x, double y) {
    x1 = std::min(x1, x);
    x2 = std::max(x2, x);
    y1 = std::min(y1, y);
    y2 = std::max(y2, y);
  }
};

struct Candidate {
  float score = 0.0F;
  double x_m = 0.0, y_m = 0.0;
  int turn = 0;  ///< in steps

  [[nodiscard]] Transform2<Map, Map> correction() const { return {x_m, y_m, turn * kStepRad}; }
};

MemoryCloud strongest(const MemoryCloud& cloud, std::size_t count) {
  MemoryCloud straight;
  std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(straight),
               [](const CloudSurface& p) { return p.weight >= 0.5; });
  MemoryCloud sample;
  const std::size_t stride = straight.size() / count + 1;
  for (std::size_t i = 0; i < straight.size(); i += stride) {
    sample.push_back(straight[i]);
  }
  return sample;
}

/// Scores of surfaces by where they come to lie, a layer a direction. In a row the even columns stand before
/// the odd ones, so that steps of two cells along x lie side by side.
class Lattice {
 public:
  Lattice(const WallIndex& index, double cell_m)
      : frame_(mapping::GridFrame::around(index.walls(), WallIndex::kRadiusM, cell_m)),
        half_(frame_.width / 2 + 1),
        scores_(static_cast<std::size_t>(WallIndex::kDirections) * frame_.height * 2 * half_, 0.0F) {
    const auto blur = scores_by_centimetre(40.0F);
    for (int direction = 0; direction < WallIndex::kDirections; ++direction)
      for (int row = 0; row < frame_.height; ++row)
        for (int column = 0; column < frame_.width; ++column) {
          const Point2<Map> p = frame_.centre(column, row);
          scores_[at(direction, row, column % 2) + column / 2] =
              blur[index.centimetres(p.x_m, p.y_m, direction)];
        }
  }

  /// Adds to scores[i] what the surface gets after the shift of (x_m + 2 i cells, y_m).
  void add(const CloudSurface& p, double x_m, double y_m, Eigen::ArrayXf& scores) const {
    const int row = cell(p.y_m + y_m - frame_.origin.y_m);
    if (row < 0 || row >= frame_.height) return;
    const int column = cell(p.x_m + x_m - frame_.origin.x_m);
    const int odd = column & 1, from = (column - odd) / 2;
    const int first = std::max(0, -from), last = std::min(static_cast<int>(scores.size()), half_ - from);
    if (first >= last) return;
    scores.segment(first, last - first) +=
        Eigen::Map<const Eigen::ArrayXf>(&scores_[at(p.direction, row, odd) + (from + first)], last - first);
  }

 private:
  [[nodiscard]] int cell(double m) const { return static_cast<int>(std::floor(m / frame_.cell_m)); }
  [[nodiscard]] std::size_t at(int direction, int row, int odd) const {
    return ((static_cast<std::size_t>(direction) * frame_.height + row) * 2 + odd) * half_;
  }

  mapping::GridFrame frame_;
  int half_;  ///< columns that are even, with one of nothing where the width is
  std::vector<float> scores_;
};

/// The best, no two of the same place.
std::vector<Transform2<Map, Map>> distinct(std::vector<Candidate> found, const Transform2<Map, Base>& at,
                                           std::size_t wanted) {
  std::sort(found.begin(), found.end(),
            [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Transform2<Map, Map>> kept;
  for (const Candidate& c : found) {
    if (kept.size() == wanted) break;
    const Transform2<Map, Map> correction = c.correction();
    if (std::none_of(kept.begin(), kept.end(), [&](const Transform2<Map, Map>& k) {
          return same_place(k * at, correction * at, kOtherM, kOtherRad);
        }))
      kept.push_back(correction);
  }
  return kept;
}

}  // namespace

MemoryCloud mirror_image(const MemoryCloud& cloud) {
  MemoryCloud mirrored = cloud;
  for (CloudSurface& p : mirrored) {
    p.x_m = -p.x_m;
    p.normal_x = -p.normal_x;
    p.direction = WallIndex::direction_of(p.normal_x, p.normal_y);
  }
  return mirrored;
}

std::vector<Transform2<Map, Map>> survey(const WallIndex& index, const MemoryCloud& cloud,
                                         const Transform2<Map, Base>& at, std::size_t wanted) {
  if (index.walls().empty()) return {};
  const MemoryCloud sample = strongest(cloud, 120);
  Box drawing;
  for (const mapping::Wall& wall : index.walls()) {
    drawing.add(wall.segment.a.x_m, wall.segment.a.y_m);
    drawing.add(wall.segment.b.x_m, wall.segment.b.y_m);
  }
  const double area = (drawing.x2 - drawing.x1) * (drawing.y2 - drawing.y1);
  const double step = std::max(0.4, std::sqrt(area * kTurns * static_cast<double>(sample.size()) / kWork));
  const Lattice lattice(index, 0.5 * step);
  std::vector<Candidate> best;
  float least = 0.0F;
  Eigen::ArrayXf scores(static_cast<Eigen::Index>((drawing.x2 - drawing.x1) / step) + 1);
  for (int r = 0; r < kTurns; ++r) {
    const Transform2<Map, Map> turn(0.0, 0.0, r * kStepRad);
    const MemoryCloud turned = moved(sample, turn);
    const Point2<Map> here = turn * at.translation();
    const double x = drawing.x1 - here.x_m;
    for (double y = drawing.y1 - here.y_m; y <= drawing.y2 - here.y_m; y += step) {
      scores.setZero();
      for (const CloudSurface& p : turned) lattice.add(p, x, y, scores);
      for (Eigen::Index i = 0; i < scores.size(); ++i)
        if (scores[i] >= least) best.push_back({scores[i], x + static_cast<double>(i) * step, y, r});
    }
    if (best.size() < kBuffer && r + 1 < kTurns) continue;
    const auto kept = static_cast<std::ptrdiff_t>(std::min(kBuffer, best.size()));
    std::nth_element(best.begin(), best.begin() + kept - 1, best.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    best.resize(static_cast<std::size_t>(kept));
    least = best.back().score;
  }
  return distinct(std::move(best), at, wanted);
}

}  // namespace madori::localization
