// The hybrid map against brute force: moments of the population, occupancy by counting, cells by sampling.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "localization/ndt_map/hybrid_map.hpp"

namespace madori::localization {
namespace {

double thousandths(int from, int to) {
  return *rc::gen::inRange(from, to + 1) / 1000.0;
}

struct Sample {
  double x, y, z;
};

std::vector<Sample> any_samples(int fewest) {
  std::vector<Sample> samples(static_cast<std::size_t>(*rc::gen::inRange(fewest, 60)));
  const double x = thousandths(-90'000, 90'000), y = thousandths(-90'000, 90'000);
  for (Sample& s : samples)
    s = {x + thousandths(-125, 125), y + thousandths(-125, 125), thousandths(0, 1900)};
  return samples;
}

CellGaussian gaussian_of(const std::vector<Sample>& samples, double most = 1e9) {
  CellGaussian g;
  for (const Sample& s : samples) g.add(s.x, s.y, s.z, most);
  return g;
}

/// Mean and covariance by their definition.
void expect_moments(const CellGaussian& g, const std::vector<Sample>& samples) {
  const auto n = static_cast<double>(samples.size());
  double x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, zz = 0;
  for (const Sample& s : samples) x += s.x / n, y += s.y / n, z += s.z / n;
  for (const Sample& s : samples) {
    xx += (s.x - x) * (s.x - x) / n, xy += (s.x - x) * (s.y - y) / n, yy += (s.y - y) * (s.y - y) / n;
    zz += (s.z - z) * (s.z - z) / n;
  }
  RC_ASSERT(std::hypot(g.x_m - x, g.y_m - y) < 1e-9);
  RC_ASSERT(std::abs(g.xx_m2 - xx) < 1e-7);
  RC_ASSERT(std::abs(g.xy_m2 - xy) < 1e-7);
  RC_ASSERT(std::abs(g.yy_m2 - yy) < 1e-7);
  RC_ASSERT(std::abs(g.z_m - z) < 1e-4);
  RC_ASSERT(std::abs(g.zz_m2 - zz) < 1e-4);
}

RC_GTEST_PROP(HybridMapProperty, AGaussianIsThePopulationsOwn, ()) {
  const auto samples = any_samples(1);
  expect_moments(gaussian_of(samples), samples);
}

RC_GTEST_PROP(HybridMapProperty, MergedGaussiansAreThoseOfAllSamples, ()) {
  const auto a = any_samples(1);
  auto all = a;
  const auto b = any_samples(0);
  CellGaussian g = gaussian_of(a);
  g.merge(gaussian_of(b), 1e9);
  all.insert(all.end(), b.begin(), b.end());
  // The samples of two cells are metres apart: squares of hundreds of metres, of which a float keeps 7
  // digits.
  CellGaussian whole = gaussian_of(all);
  const double scale = 1.0 + whole.xx_m2 + whole.yy_m2;
  RC_ASSERT(std::hypot(g.x_m - whole.x_m, g.y_m - whole.y_m) < 1e-6 * scale);
  RC_ASSERT(std::abs(g.xx_m2 - whole.xx_m2) < 1e-5F * static_cast<float>(scale));
  RC_ASSERT(std::abs(g.xy_m2 - whole.xy_m2) < 1e-5F * static_cast<float>(scale));
  RC_ASSERT(g.samples == whole.samples);
}

/// Beyond the cap a new sample weighs 1 / (cap + 1), so that the mean is the sum of all with those weights.
RC_GTEST_PROP(HybridMapProperty, ACappedGaussianForgets, ()) {
  const auto samples = any_samples(2);
  const double cap = *rc::gen::inRange(1, 40);
  const CellGaussian g = gaussian_of(samples, cap);
  double x = 0.0, y = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double weight = 1.0 / (std::min(static_cast<double>(i), cap) + 1.0);
    for (std::size_t k = i + 1; k < samples.size(); ++k) {
      const double n = std::min(static_cast<double>(k), cap);
      weight *= n / (n + 1.0);
    }
    x += weight * samples[i].x, y += weight * samples[i].y;
  }
  RC_ASSERT(std::hypot(g.x_m - x, g.y_m - y) < 1e-6);
}

/// A level look of random beams from the origin.
struct Look {
  Beams beams;
  Transform2<Map, Base> pose;
};

Look any_look() {
  Look look;
  look.pose = {thousandths(-3000, 3000) + 0.013, thousandths(-3000, 3000) + 0.017,
               3.0 * thousandths(-1000, 1000)};
  look.beams.sensor_z_m = 0.5;
  for (int i = *rc::gen::inRange(1, 40); i > 0; --i) {
    const double angle = kPi * thousandths(-1000, 1000), range = thousandths(500, 9000);
    look.beams.ends.push_back(
        {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.5F});
  }
  return look;
}

using Place = std::array<int, 2>;

/// Each cell's count of ends, and whether a beam passes it, by small steps along every beam.
void count(const Look& look, double cell_m, std::map<Place, int>& ends,
           std::map<Place, std::set<std::size_t>>& passed) {
  const Point2<Map> from = look.pose.translation();
  for (std::size_t i = 0; i < look.beams.ends.size(); ++i) {
    const auto& end = look.beams.ends[i];
    const Point2<Map> to = look.pose * Point2<Base>{end.x_m, end.y_m};
    const auto place = [&](double t) {
      return Place{static_cast<int>(std::floor((from.x_m + t * (to.x_m - from.x_m)) / cell_m)),
                   static_cast<int>(std::floor((from.y_m + t * (to.y_m - from.y_m)) / cell_m))};
    };
    const Place last = place(1.0);
    ++ends[last];
    constexpr int kSteps = 4000;
    for (int k = 0; k < kSteps; ++k)
      if (place(static_cast<double>(k) / kSteps) != last)
        passed[place(static_cast<double>(k) / kSteps)].insert(i);
  }
}

/// In cells in which nothing ends, every beam that passes says the same: occupancy is a count. Where beams
/// end and none passes, likewise.
RC_GTEST_PROP(HybridMapProperty, OccupancyIsWhatCountingSays, ()) {
  const Look look = any_look();
  HybridMap map;
  map.look(look.beams, look.pose, stamp_from_seconds(100.0));
  std::map<Place, int> ends;
  std::map<Place, std::set<std::size_t>> passed;
  count(look, map.options().cell_m, ends, passed);
  const auto& o = map.options();
  int wrong = 0, seen = 0;
  for (const auto& [place, beams] : passed) {
    const auto cell = map.cells().find({place[0], place[1]});
    RC_ASSERT(cell != CellTree::kNone);
    if (ends.contains(place)) continue;
    ++seen;
    const double by_count = -std::min(o.layers.look_most, o.pass * static_cast<double>(beams.size()));
    wrong += std::abs(map.cells()[cell].layers.now - by_count) > 1e-5 ? 1 : 0;
  }
  // Where a beam cuts off less of a corner than a step is long, stepping does not see it.
  RC_ASSERT(wrong <= 1 + seen / 50);
  int beside = 0;
  for (const auto& [place, n] : ends) {
    if (passed.contains(place)) continue;
    const auto cell = map.cells().find({place[0], place[1]});
    RC_ASSERT(cell != CellTree::kNone);
    const double by_count = std::min(o.layers.look_most, o.hit * n);
    beside += std::abs(map.cells()[cell].layers.now - by_count) > 1e-5 ? 1 : 0;
    RC_ASSERT(map.cells()[cell].gaussian.samples == static_cast<float>(n));
  }
  RC_ASSERT(beside <= 1);
}

RC_GTEST_PROP(HybridMapProperty, TheTreeHoldsWhatWasPutIn, ()) {
  CellTree tree;
  std::map<Place, CellTree::Index> oracle;
  for (int i = *rc::gen::inRange(1, 200); i > 0; --i) {
    const Place p{*rc::gen::inRange(-CellTree::kHalf, CellTree::kHalf), *rc::gen::inRange(-40, 40)};
    const auto cell = tree.at({p[0], p[1]});
    RC_ASSERT(!oracle.contains(p) || oracle[p] == cell);
    oracle[p] = cell;
  }
  RC_ASSERT(tree.size() == oracle.size());
  for (const auto& [p, cell] : oracle) RC_ASSERT(tree.find({p[0], p[1]}) == cell);
  const Place other{*rc::gen::inRange(-CellTree::kHalf, CellTree::kHalf), 41};
  RC_ASSERT(tree.find({other[0], other[1]}) == CellTree::kNone);
}

/// However long it looks, and wherever: memory has an end, and what was seen last is there.
RC_GTEST_PROP(HybridMapProperty, MemoryHasAnEnd, ()) {
  HybridMapOptions options;
  options.most_cells = 300;
  HybridMap map(options);
  Look look;
  for (int i = 0; i < 8; ++i) {
    look = any_look();
    map.look(look.beams, look.pose, stamp_from_seconds(100.0 + i));
    RC_ASSERT(map.cells().size() <= options.most_cells || map.cells().size() == 0);
  }
  RC_ASSERT(map.newest() == stamp_from_seconds(107.0));
}

}  // namespace
}  // namespace madori::localization
