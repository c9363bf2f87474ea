#include "localization/drawing_fit/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace madori::localization {
namespace {

constexpr double kStepRad = to_rad(4.0);
constexpr int kTurns = 90;
constexpr double kMarginM = 3.0;  // the memory may reach this far beyond the drawing
constexpr double kWork = 6e7;     // looks at the tables that one survey may take
constexpr std::size_t kRefined = 8;
constexpr double kOtherM = 1.5;  // a place this far, or turned by this much, is another place
constexpr double kOtherRad = to_rad(15.0);

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

/// The best places on a grid over all of the drawing that the cloud fits into.
std::vector<Candidate> candidates(const WallIndex& index, const MemoryCloud& cloud) {
  const MemoryCloud sample = strongest(cloud, 120);
  Box drawing;
  for (const mapping::Wall& wall : index.walls()) {
    drawing.add(wall.segment.a.x_m, wall.segment.a.y_m);
    drawing.add(wall.segment.b.x_m, wall.segment.b.y_m);
  }
  const double area = (drawing.x2 - drawing.x1 + kMarginM) * (drawing.y2 - drawing.y1 + kMarginM);
  const double step = std::max(0.5, std::sqrt(area * kTurns * static_cast<double>(sample.size()) / kWork));
  std::vector<Candidate> best;
  for (int r = 0; r < kTurns; ++r) {
    const Transform2<Map, Map> turn(0.0, 0.0, r * kStepRad);
    const MemoryCloud turned = moved(sample, turn);
    Box box;
    for (const CloudSurface& p : turned) box.add(p.x_m, p.y_m);
    for (double y = drawing.y1 - kMarginM - box.y1; y <= drawing.y2 + kMarginM - box.y2; y += step) {
      for (double x = drawing.x1 - kMarginM - box.x1; x <= drawing.x2 + kMarginM - box.x2; x += step) {
        best.push_back({score(index, turned, x, y), Transform2<Map, Map>(x, y, r * kStepRad)});
      }
    }
    if (best.size() > 4096 || r + 1 == kTurns) {
      const auto keep = static_cast<long>(std::min<std::size_t>(64, best.size()));
      std::partial_sort(best.begin(), best.begin() + keep, best.end(),
                        [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
      best.resize(static_cast<std::size_t>(keep));
    }
  }
  return best;
}

MemoryCloud mirror_image(const MemoryCloud& cloud) {
  MemoryCloud mirrored = cloud;
  for (CloudSurface& p : mirrored) {
    p.x_m = -p.x_m;
    p.normal_x = -p.normal_x;
    p.direction = WallIndex::direction_of(p.normal_x, p.normal_y);
  }
  return mirrored;
}

/// Refines the best few candidates that `wanted` allows.
template <class Wanted>
Candidate best_place(const DrawingFit& fit, const MemoryCloud& cloud, Wanted&& wanted) {
  Candidate best;
  std::size_t refined = 0;
  for (const Candidate& c : candidates(fit.index(), cloud)) {
    if (refined >= kRefined) break;
    if (!wanted(c.correction)) continue;
    ++refined;
    const Alignment found = fit.settle(cloud, c.correction);
    if (wanted(found.correction) && found.likelihood > best.score) {
      best = {found.likelihood, found.correction};
    }
  }
  return best;
}

}  // namespace

Transform2<Map, Map> best_place_of_all(const DrawingFit& fit, const MemoryCloud& cloud) {
  return best_place(fit, cloud, [](const Transform2<Map, Map>&) { return true; }).correction;
}

Survey survey(const DrawingFit& fit, const MemoryCloud& cloud) {
  Survey result;
  Point2<Map> centre;
  for (const CloudSurface& p : cloud) {
    centre.x_m += p.x_m / static_cast<double>(cloud.size());
    centre.y_m += p.y_m / static_cast<double>(cloud.size());
  }
  const auto is_other = [&](const Transform2<Map, Map>& t) {
    return distance_m(t * centre, centre) > kOtherM || std::abs(t.yaw_rad()) > kOtherRad;
  };
  result.here_nats = fit.settle(cloud, {}).likelihood;
  const Candidate other = best_place(fit, cloud, is_other);
  result.elsewhere_nats = other.score;
  result.elsewhere = other.correction;
  result.mirrored_nats =
      best_place(fit, mirror_image(cloud), [](const Transform2<Map, Map>&) { return true; }).score;
  return result;
}

}  // namespace madori::localization
