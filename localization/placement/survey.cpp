#include "localization/placement/survey.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "localization/drawing_fit/wall_hits.hpp"
#include "localization/global/global_answer.hpp"

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
  double score = 0.0;
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

/// How well the sample lies on walls after the shifts (shifts_m[i], dy).
void score_row(const WallIndex& index, const MemoryCloud& sample, const std::vector<double>& shifts_m,
               double dy, std::vector<double>& scores) {
  static const auto blur = scores_by_centimetre(40.0F);
  scores.assign(shifts_m.size(), 0.0);
  for (const CloudSurface& p : sample)
    index.for_each_shift(p.x_m, p.y_m + dy, p.direction, shifts_m,
                         [&](std::size_t i, std::uint8_t centimetres) { scores[i] += blur[centimetres]; });
}

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
  const MemoryCloud sample = strongest(cloud, 120);
  Box drawing;
  for (const mapping::Wall& wall : index.walls()) {
    drawing.add(wall.segment.a.x_m, wall.segment.a.y_m);
    drawing.add(wall.segment.b.x_m, wall.segment.b.y_m);
  }
  const double area = (drawing.x2 - drawing.x1) * (drawing.y2 - drawing.y1);
  const double step = std::max(0.4, std::sqrt(area * kTurns * static_cast<double>(sample.size()) / kWork));
  std::vector<Candidate> best;
  std::vector<double> shifts_m, scores;
  for (int r = 0; r < kTurns; ++r) {
    const Transform2<Map, Map> turn(0.0, 0.0, r * kStepRad);
    const MemoryCloud turned = moved(sample, turn);
    const Point2<Map> here = turn * at.translation();
    shifts_m.clear();
    for (double x = drawing.x1 - here.x_m; x <= drawing.x2 - here.x_m; x += step) shifts_m.push_back(x);
    for (double y = drawing.y1 - here.y_m; y <= drawing.y2 - here.y_m; y += step) {
      score_row(index, turned, shifts_m, y, scores);
      for (std::size_t i = 0; i < shifts_m.size(); ++i) best.push_back({scores[i], shifts_m[i], y, r});
    }
    if (best.size() < kBuffer && r + 1 < kTurns) continue;
    const auto kept = static_cast<std::ptrdiff_t>(std::min(kBuffer, best.size()));
    std::nth_element(best.begin(), best.begin() + kept - 1, best.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    best.resize(static_cast<std::size_t>(kept));
  }
  return distinct(std::move(best), at, wanted);
}

}  // namespace madori::localization
