#include "localization/placement/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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
  Transform2<Map, Map> correction;
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

double score(const WallIndex& index, const MemoryCloud& sample, double dx, double dy) {
  static const auto blur = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < 255; ++i) {
      const float z = static_cast<float>(i) / 40.0F;
      t[i] = std::exp(-0.5F * z * z);
    }
    return t;
  }();
  double sum = 0.0;
  for (const CloudSurface& p : sample) {
    sum += blur[index.centimetres(p.x_m + dx, p.y_m + dy, p.direction)];
  }
  return sum;
}

/// Keeps the best, no two of the same place.
void keep_distinct(std::vector<Candidate>& found, const Transform2<Map, Base>& at, std::size_t wanted) {
  std::sort(found.begin(), found.end(),
            [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> kept;
  for (const Candidate& c : found) {
    if (kept.size() == wanted) break;
    if (std::none_of(kept.begin(), kept.end(), [&](const Candidate& k) {
          return same_place(k.correction * at, c.correction * at, kOtherM, kOtherRad);
        }))
      kept.push_back(c);
  }
  found = std::move(kept);
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
  for (int r = 0; r < kTurns; ++r) {
    const Transform2<Map, Map> turn(0.0, 0.0, r * kStepRad);
    const MemoryCloud turned = moved(sample, turn);
    const Point2<Map> here = turn * at.translation();
    for (double y = drawing.y1 - here.y_m; y <= drawing.y2 - here.y_m; y += step)
      for (double x = drawing.x1 - here.x_m; x <= drawing.x2 - here.x_m; x += step)
        best.push_back({score(index, turned, x, y), Transform2<Map, Map>(x, y, r * kStepRad)});
    if (best.size() < kBuffer && r + 1 < kTurns) continue;
    const auto kept = static_cast<std::ptrdiff_t>(std::min(kBuffer, best.size()));
    std::nth_element(best.begin(), best.begin() + kept - 1, best.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    best.resize(static_cast<std::size_t>(kept));
  }
  keep_distinct(best, at, wanted);
  std::vector<Transform2<Map, Map>> corrections;
  for (const Candidate& c : best) corrections.push_back(c.correction);
  return corrections;
}

}  // namespace madori::localization
