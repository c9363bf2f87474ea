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
constexpr double kWork = 1.2e8;  // looks that one survey may take: a large drawing has larger steps
constexpr double kLeastStepM = 0.4;
constexpr double kBlurM = 0.4;   // drawn walls stand about so far from where they are drawn
constexpr double kOtherM = 0.9;  // a place this far, or turned by this much, is another place
constexpr double kOtherRad = to_rad(10.0);
constexpr std::size_t kBuffer = 8192;
constexpr std::size_t kRefined = 300;  // places of the lattice that are looked at closely

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
  double x_m = 0.0, y_m = 0.0, turn_rad = 0.0;

  [[nodiscard]] Transform2<Map, Map> correction() const { return {x_m, y_m, turn_rad}; }
};

bool is_likelier(const Candidate& a, const Candidate& b) {
  return a.score > b.score;
}

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
  Lattice(const WallIndex& index, double cell_m, double blur_m)
      : frame_(mapping::GridFrame::around(index.walls(), WallIndex::kRadiusM, cell_m)),
        half_(frame_.width / 2 + 1),
        scores_(static_cast<std::size_t>(WallIndex::kDirections) * frame_.height * 2 * half_, 0.0F) {
    const auto blur = scores_by_centimetre(static_cast<float>(100.0 * blur_m));
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

/// The best, no two of the same place, the best first.
std::vector<Candidate> distinct(std::vector<Candidate> found, const Transform2<Map, Base>& at,
                                std::size_t wanted) {
  std::sort(found.begin(), found.end(), is_likelier);
  std::vector<Candidate> kept;
  std::vector<Transform2<Map, Base>> places;
  for (const Candidate& c : found) {
    if (kept.size() == wanted) break;
    const Transform2<Map, Base> place = c.correction() * at;
    if (std::any_of(places.begin(), places.end(),
                    [&](const auto& p) { return same_place(p, place, kOtherM, kOtherRad); }))
      continue;
    kept.push_back(c);
    places.push_back(place);
  }
  return kept;
}

float score_at(const WallIndex& index, const MemoryCloud& sample, const Transform2<Map, Map>& correction) {
  static const auto scores = scores_by_centimetre(static_cast<float>(100.0 * kBlurM));
  float sum = 0.0F;
  for (const CloudSurface& p : sample) {
    const Point2<Map> q = correction * Point2<Map>{p.x_m, p.y_m};
    sum += scores[index.centimetres(q.x_m, q.y_m, turned_direction(p, correction))];
  }
  return sum;
}

/// The best near a place of a lattice whose steps are wider than the blur: they and the turns are halved
/// until they are not.
Candidate refined(const WallIndex& index, const MemoryCloud& sample, const Transform2<Map, Base>& at,
                  Candidate best, double step_m) {
  best.score = score_at(index, sample, best.correction());
  for (double halved = 0.5; 2.0 * halved * step_m > kBlurM; halved *= 0.5) {
    const Candidate centre = best;
    const Point2<Map> vehicle = centre.correction() * at.translation();
    for (const double turn : {-halved, 0.0, halved}) {
      const double turn_rad = centre.turn_rad + turn * kStepRad;
      const Point2<Map> turned = Transform2<Map, Map>(0.0, 0.0, turn_rad) * at.translation();
      for (const double x : {-halved, 0.0, halved})
        for (const double y : {-halved, 0.0, halved}) {
          Candidate near{0.0F, vehicle.x_m - turned.x_m + x * step_m, vehicle.y_m - turned.y_m + y * step_m,
                         turn_rad};
          near.score = score_at(index, sample, near.correction());
          if (near.score > best.score) best = near;
        }
    }
  }
  return best;
}

/// The likeliest on a lattice of places over the drawing and of turns.
std::vector<Candidate> coarse(const Lattice& lattice, const Box& drawing, const MemoryCloud& sample,
                              const Transform2<Map, Base>& at, double step_m) {
  std::vector<Candidate> best;
  float least = 0.0F;
  Eigen::ArrayXf scores(static_cast<Eigen::Index>((drawing.x2 - drawing.x1) / step_m) + 1);
  for (int r = 0; r < kTurns; ++r) {
    const Transform2<Map, Map> turn(0.0, 0.0, r * kStepRad);
    const MemoryCloud turned = moved(sample, turn);
    const Point2<Map> here = turn * at.translation();
    const double x = drawing.x1 - here.x_m;
    for (double y = drawing.y1 - here.y_m; y <= drawing.y2 - here.y_m; y += step_m) {
      scores.setZero();
      for (const CloudSurface& p : turned) lattice.add(p, x, y, scores);
      for (Eigen::Index i = 0; i < scores.size(); ++i)
        if (scores[i] >= least)
          best.push_back({scores[i], x + static_cast<double>(i) * step_m, y, r * kStepRad});
    }
    if (best.size() <= kBuffer) continue;
    std::nth_element(best.begin(), best.begin() + (kBuffer - 1), best.end(), is_likelier);
    best.resize(kBuffer);
    least = best.back().score;
  }
  return best;
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
  const double step_m =
      std::max(kLeastStepM, std::sqrt(area * kTurns * static_cast<double>(sample.size()) / kWork));
  const double between_m =
      step_m / std::sqrt(2.0);  // as far as a place may be from the next one of the lattice
  const Lattice lattice(index, 0.5 * step_m, std::max(kBlurM, between_m));
  std::vector<Candidate> best = distinct(coarse(lattice, drawing, sample, at, step_m), at, kRefined);
  if (step_m > kBlurM)
    for (Candidate& c : best) c = refined(index, sample, at, c, step_m);
  std::vector<Transform2<Map, Map>> likeliest;
  for (const Candidate& c : distinct(std::move(best), at, wanted)) likeliest.push_back(c.correction());
  return likeliest;
}

}  // namespace madori::localization
